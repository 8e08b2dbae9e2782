// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace hotfire {

/// Checks that the elements of a MATLAB 5 or 7 file lie within each other and within the file, before a library follows
/// them. What is inside compressed elements, files of MATLAB 4 and files of MATLAB 7.3 (HDF5) is left to the library.
/// Throws FileError `path: byte N: problem`.
/// Source: The MathWorks, MAT-File Format (R2023b), "Level 5 MAT-File Format": tags, small elements, padding to 8 bytes.
void require_matlab_layout(const std::filesystem::path& path);

}  // namespace hotfire
