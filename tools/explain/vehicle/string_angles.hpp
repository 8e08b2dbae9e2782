// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/files/record/record.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::explain {

/// The record with `engine` channels of every engine that has four strings and no such channel: the angles [rad] at which
/// the nominal strings of the model best have the measured lengths [m], by least squares. The strings that were used are
/// left out. A row without a length has no angle (NaN).
///
/// An error of the anchors is an error of gain and zero, as of any sensor: `hotfire strings` calibrates them on settled
/// poses. Throws FileError for strings with a lag, which is not simulated.
Record with_string_angles(const VehicleFile& vehicle, Record record);

}  // namespace hotfire::explain
