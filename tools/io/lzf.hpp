// SPDX-License-Identifier: Apache-2.0
// Decompression of LZF blocks (Marc Lehmann's liblzf stream format), which PCD's binary_compressed uses.
//
// A control byte c < 32 is followed by c + 1 literal bytes. Otherwise its upper three bits are a length (7: one more
// byte is added), its lower five bits and the byte after are a distance back; length + 2 bytes are copied from there.
#pragma once

#include <string>
#include <string_view>

namespace mapweld::io {

// False unless `compressed` is well formed and gives exactly `size` bytes. `size` is not believed beyond what LZF can
// reach at best, so a forged one does not make us allocate.
bool DecompressLzf(std::string_view compressed, std::size_t size, std::string* bytes);

}  // namespace mapweld::io
