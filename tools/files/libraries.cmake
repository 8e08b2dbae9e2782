# SPDX-License-Identifier: Apache-2.0
# The libraries of Debian that the readers of tools/files need, for their own build and for that of the fuzzers.
find_package(fmt REQUIRED)
find_package(OpenSSL REQUIRED)
find_path(UDUNITS2_INCLUDE_DIR udunits2.h PATH_SUFFIXES udunits2 REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
find_path(MATIO_INCLUDE_DIR matio.h REQUIRED)
find_library(MATIO_LIBRARY matio REQUIRED)
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(HDF5_LIBRARY hdf5_serial REQUIRED)
find_package(ZLIB REQUIRED)
