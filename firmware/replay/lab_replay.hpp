// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/lab/lab_image.hpp"
#include "firmware/replay/replay.hpp"

namespace hotfire::firmware {

/// Replays the recording of a lab: what it saw in every cycle is given to its logic again, from the recorded profile and
/// limits. State, first fault, commands, currents and positions have to be the recorded bits. What becomes of frames and
/// lines before the logic sees them is not replayed.
Replay replay_lab(hal::RecordingReader& reader);

}  // namespace hotfire::firmware
