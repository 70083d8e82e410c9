// SPDX-License-Identifier: Apache-2.0
// The messages of an Xsens MTi on CAN, with their default 11-bit identifiers. All values are big-endian.
// Source: the vendor's CAN message pages for the MTi-600 series and the 2019 manual (MT1604P).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace mapweld::can {

enum class XsensField : std::uint8_t {
  kNone,          // a message of the device that odometry does not need
  kSampleTime,    // u32, 100 us or 1 us
  kGroupCounter,  // u16, joins the frames of one sample
  kStatusWord,    // u32 bits
  kRateOfTurn,    // 3 x i16, 2^-9 rad/s
  kAcceleration,  // 3 x i16, 2^-8 m/s^2
};

struct XsensMessage {
  std::uint16_t id;
  std::uint8_t dlc;
  XsensField field;
};

inline constexpr std::array kXsensMessages{
    XsensMessage{0x001, 1, XsensField::kNone},          // Error
    XsensMessage{0x002, 1, XsensField::kNone},          // Warning
    XsensMessage{0x005, 4, XsensField::kSampleTime},    //
    XsensMessage{0x006, 2, XsensField::kGroupCounter},  //
    XsensMessage{0x007, 8, XsensField::kNone},          // UTC
    XsensMessage{0x011, 4, XsensField::kStatusWord},    //
    XsensMessage{0x021, 8, XsensField::kNone},          // Quaternion
    XsensMessage{0x022, 6, XsensField::kNone},          // EulerAngles
    XsensMessage{0x031, 7, XsensField::kNone},          // DeltaV
    XsensMessage{0x032, 6, XsensField::kRateOfTurn},    //
    XsensMessage{0x033, 8, XsensField::kNone},          // DeltaQ
    XsensMessage{0x034, 6, XsensField::kAcceleration},  //
    XsensMessage{0x035, 6, XsensField::kNone},          // FreeAcceleration
    XsensMessage{0x041, 6, XsensField::kNone},          // MagneticField
    XsensMessage{0x051, 2, XsensField::kNone},          // Temperature
    XsensMessage{0x052, 4, XsensField::kNone},          // BaroPressure
    XsensMessage{0x061, 6, XsensField::kNone},          // RateOfTurnHR or AccelerationHR: see XsensStart
    XsensMessage{0x062, 6, XsensField::kNone},          // the other one
    XsensMessage{0x071, 8, XsensField::kNone},          // LatLon
    XsensMessage{0x072, 4, XsensField::kNone},          // AltitudeEllipsoid
    XsensMessage{0x073, 4, XsensField::kNone},          // ECEF X
    XsensMessage{0x074, 4, XsensField::kNone},          // ECEF Y
    XsensMessage{0x075, 4, XsensField::kNone},          // ECEF Z
    XsensMessage{0x076, 6, XsensField::kNone},          // VelocityXYZ
    XsensMessage{0x079, 5, XsensField::kNone},          // GNSS receiver status
    XsensMessage{0x07A, 8, XsensField::kNone},          // GNSS DOP
};
static_assert(std::ranges::is_sorted(kXsensMessages, {}, &XsensMessage::id));

// For the kernel's filter: what the codec makes use of.
inline constexpr std::array<std::uint32_t, 5> kXsensWantedIds{0x005, 0x006, 0x011, 0x032, 0x034};

// Bytes of a message that odometry needs, whatever its identifier.
constexpr std::uint8_t DlcOf(XsensField field) {
  for (const XsensMessage& message : kXsensMessages) {
    if (message.field == field) return message.dlc;
  }
  return 0;
}

// StatusWord: clipping of the accelerometer and gyroscope axes. Bits 14 to 16 tell of the magnetometer, which is not
// used.
inline constexpr std::uint32_t kXsensClippingBits = 0x3FU << 8U;

constexpr const XsensMessage* FindXsensMessage(std::uint32_t id) {
  const auto* it =
      std::ranges::lower_bound(kXsensMessages, id, {}, [](const XsensMessage& m) { return std::uint32_t{m.id}; });
  return it != kXsensMessages.end() && it->id == id ? it : nullptr;
}

}  // namespace mapweld::can
