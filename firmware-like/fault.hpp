// SPDX-License-Identifier: Apache-2.0
// What remains of a failed assertion: one line on stderr and in <state-dir>/fault, then the process ends and the
// service manager starts it again.
#pragma once

namespace mapweld::executive {

// Opens <state_dir>/fault for appending and installs the assert handler. Works without the file, too.
void InstallFaultRecorder(const char* state_dir);

}  // namespace mapweld::executive
