// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_exit.h"

#include "dataset/netcdf/hdf5_id.h"

namespace beamgyro::internal {

void keep_hdf5_open_at_exit() { check_hdf5(H5dont_atexit(), "start HDF5"); }

}  // namespace beamgyro::internal
