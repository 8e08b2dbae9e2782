// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/lab/lab_image.hpp"
#include "firmware/replay/replay.hpp"

namespace hotfire::firmware {

/// Replays the recording of a lab: its logic gets the recorded inputs of every cycle again, with the recorded profile and
/// limits. State, first fault, commands, currents and positions must equal the recorded bits. The processing of frames and
/// lines before the logic is not replayed.
Replay replay_lab(hal::RecordingReader& reader);

}  // namespace hotfire::firmware
