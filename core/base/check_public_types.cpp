// SPDX-License-Identifier: Apache-2.0
// Compiles every data type of the public API once, so that a header which does not stand alone or
// breaks the layout rules fails here and not in a user's program.
#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/geometry.hpp>
#include <xtrack/image.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/phase_map.hpp>
#include <xtrack/point_cloud.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/source.hpp>
#include <xtrack/stamp.hpp>

static_assert(alignof(xtrack::Rig) <= alignof(double));
static_assert(alignof(xtrack::PointCloud) <= alignof(void*));
