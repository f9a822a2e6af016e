// SPDX-License-Identifier: MIT
/// \file
/// Which names the shared library shows.
#pragma once

/// Stands before the name of a namespace whose members the shared library
/// shows. The sources are compiled with all names hidden.
#define BEAMGYRO_PUBLIC [[gnu::visibility("default")]]
