// SPDX-License-Identifier: Apache-2.0
// Every public data type through a library by value: compiled once for the baseline CPU
// (abi_echo.cpp), called from a program that is compiled for the CPU at hand.
#pragma once

#include <cstddef>

#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/gesture_event.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/phase_map.hpp>
#include <xtrack/point_cloud.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack::abi {

struct Layout {
    std::size_t size = 0;
    std::size_t alignment = 0;
    friend bool operator==(const Layout&, const Layout&) = default;
};

/// What the library believes; abi_echo.cpp instantiates it for every type below.
template <typename T>
Layout layout_in_library();

/// Each takes a value, changes every field in a way that is easy to foretell (numbers grow by one,
/// flags turn), and gives it back.
Stamp echo(Stamp value);
Result<Stamp> echo(Result<Stamp> value);
Frame echo(Frame value);
Pattern echo(Pattern value);
PatternSequence echo(PatternSequence value);
Rig echo(Rig value);
PhaseMap echo(PhaseMap value);
DepthFrame echo(DepthFrame value);
PointCloud echo(PointCloud value);
Hand echo(Hand value);
HandFrame echo(HandFrame value);
GestureEvent echo(GestureEvent value);

}  // namespace xtrack::abi
