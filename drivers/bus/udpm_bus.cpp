// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_bus.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "drivers/bus/udpm_socket.hpp"

namespace mapweld::bus {
namespace {

template <class T>
bool SetOption(int fd, int level, int name, const T& value) {
  return ::setsockopt(fd, level, name, &value, sizeof(value)) == 0;
}

const sockaddr* AsSockaddr(const sockaddr_in* address) {
  return reinterpret_cast<const sockaddr*>(address);
}

// A multicast packet needs a route even when it stays on the machine. Asked once, at boot, where it can still be said.
bool HasRoute(int fd, const sockaddr_in& group) {
  if (::connect(fd, AsSockaddr(&group), sizeof(group)) != 0) return false;
  const sockaddr_in none{.sin_family = AF_UNSPEC, .sin_port = 0, .sin_addr = {}, .sin_zero = {}};
  return ::connect(fd, AsSockaddr(&none), sizeof(none)) == 0;
}

}  // namespace

Status UdpmBus::OpenSender(const UdpmAddress& address) {
  send_fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (send_fd_ < 0) return Status::kIo;
  const int ttl = address.ttl;
  const int loop = 1;
  const bool ready = SetOption(send_fd_, IPPROTO_IP, IP_MULTICAST_TTL, ttl) &&
                     SetOption(send_fd_, IPPROTO_IP, IP_MULTICAST_LOOP, loop) && HasRoute(send_fd_, group_);
  return ready ? Status::kOk : Status::kIo;
}

Status UdpmBus::Open(std::string_view url, std::string_view channel_prefix) {
  Close();
  UdpmAddress address;
  if (const Status status = ParseLcmUrl(url, &address); status != Status::kOk) return status;
  if (channel_prefix.size() > prefix_.size()) return Status::kOutOfRange;
  std::copy(channel_prefix.begin(), channel_prefix.end(), prefix_.begin());
  prefix_bytes_ = channel_prefix.size();
  group_ = {};
  group_.sin_family = AF_INET;
  group_.sin_port = htons(address.port);
  group_.sin_addr.s_addr = htonl(address.group_ipv4);
  receive_fd_ = OpenUdpmReceiver(address);
  const Status status = receive_fd_ >= 0 ? OpenSender(address) : Status::kIo;
  if (status != Status::kOk) {
    const int why = errno;
    Close();
    errno = why;
  }
  return status;
}

void UdpmBus::Close() {
  if (receive_fd_ >= 0) (void)::close(receive_fd_);
  if (send_fd_ >= 0) (void)::close(send_fd_);
  receive_fd_ = send_fd_ = -1;
  drops_ = {};
}

Status UdpmBus::Publish(std::string_view channel, std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, kShortHeaderBytes + kMaxChannelBytes + 1> header;
  const Result<std::size_t> header_bytes = EncodeShortHeader(sequence_, channel, header);
  if (!header_bytes.ok() || header_bytes.value() + payload.size() > kMaxDatagramBytes) return Status::kOutOfRange;
  // sendmsg does not write through these pointers; the interface is older than const.
  std::array<iovec, 2> iov{{{.iov_base = header.data(), .iov_len = header_bytes.value()},
                            {.iov_base = const_cast<std::uint8_t*>(payload.data()), .iov_len = payload.size()}}};
  msghdr message{};
  message.msg_name = &group_;
  message.msg_namelen = sizeof(group_);
  message.msg_iov = iov.data();
  message.msg_iovlen = iov.size();
  ++sequence_;
  if (::sendmsg(send_fd_, &message, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
    ++counters_.send_failed;
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS ? Status::kFull : Status::kIo;
  }
  ++counters_.sent;
  counters_.sent_bytes += payload.size();
  return Status::kOk;
}

void UdpmBus::Deliver(const BusMessage& message, const MessageSink& sink) {
  if (!message.channel.starts_with(std::string_view(prefix_.data(), prefix_bytes_))) {
    ++counters_.ignored;
    return;
  }
  ++counters_.received;
  counters_.received_bytes += message.payload.size();
  sink.fn(sink.context, message.channel, message.payload);
}

void UdpmBus::Count(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      break;
    case Refusal::kTooShort:
      ++counters_.too_short;
      break;
    case Refusal::kMagic:
      ++counters_.wrong_magic;
      break;
    case Refusal::kChannel:
      ++counters_.wrong_channel;
      break;
    case Refusal::kTooLarge:
      ++counters_.too_large;
      break;
    case Refusal::kFragment:
      ++counters_.wrong_fragment;
      break;
    case Refusal::kContradicts:
      ++counters_.contradicting;
      break;
  }
}

std::uint64_t UdpmBus::Rejected() const {
  const Counters& c = counters_;
  return c.too_short + c.wrong_magic + c.wrong_channel + c.too_large + c.wrong_fragment + c.contradicting;
}

void UdpmBus::Handle(std::span<const std::uint8_t> datagram, const Sender& sender, const MessageSink& sink) {
  ParsedDatagram parsed;
  Refusal refusal = ParseDatagram(datagram, &parsed);
  if (refusal == Refusal::kNone && !parsed.fragment) {
    Deliver({.channel = parsed.channel, .payload = parsed.payload}, sink);
  } else if (refusal == Refusal::kNone) {
    BusMessage message;
    const Status status = reassembly_.Push(parsed, sender, &message, &refusal);
    if (refusal == Refusal::kNone) ++counters_.fragments;
    if (status == Status::kOk) Deliver(message, sink);
  }
  Count(refusal);
}

Result<std::size_t> UdpmBus::Receive(const MessageSink& sink, std::size_t max_datagrams) {
  if (receive_fd_ < 0) return Status::kIo;
  for (std::size_t taken = 0; taken < max_datagrams; ++taken) {
    sockaddr_in from{};
    iovec iov{.iov_base = buffer_.data(), .iov_len = buffer_.size()};
    msghdr header{};
    header.msg_name = &from;
    header.msg_namelen = sizeof(from);
    header.msg_iov = &iov;
    header.msg_iovlen = 1;
    header.msg_control = control_.bytes.data();
    header.msg_controllen = control_.bytes.size();
    const ssize_t got = ::recvmsg(receive_fd_, &header, MSG_DONTWAIT);
    if (got < 0) {
      const bool nothing = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ENETDOWN;
      return nothing ? Result<std::size_t>(taken) : Result<std::size_t>(Status::kIo);
    }
    // The stamp is not used, so the clocks need not be read.
    (void)drops_.Update(time::ReadReceiveInfo(header, {}));
    counters_.kernel_drops = drops_.total();
    Handle(std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(got)),
           {.ipv4 = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)}, sink);
  }
  return max_datagrams;
}

}  // namespace mapweld::bus
