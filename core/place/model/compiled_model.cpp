// SPDX-License-Identifier: Apache-2.0
// place.mwm as part of the program. tools/train/run makes it; docs/descriptor.md is its model card.
#include "core/place/trained_code.hpp"

// Global, because the linker for aarch64 confuses two local labels that are reached through its table of addresses;
// hidden, because they are nobody else's.
asm(".section .rodata\n"
    ".globl mapweld_place_model, mapweld_place_model_end\n"
    ".hidden mapweld_place_model, mapweld_place_model_end\n"
    ".balign 64\n"
    "mapweld_place_model:\n"
    ".incbin \"" MAPWELD_PLACE_MODEL
    "\"\n"
    "mapweld_place_model_end:\n"
    ".byte 0\n"
    ".previous\n");

namespace mapweld::place {

extern "C" const std::uint8_t mapweld_place_model[];
extern "C" const std::uint8_t mapweld_place_model_end[];

std::span<const std::uint8_t> CompiledModel() {
  return {mapweld_place_model, mapweld_place_model_end};
}

}  // namespace mapweld::place
