// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/hand.hpp>
#include <xtrack/source.hpp>

namespace xtrack {

/// Hands from any tracker: a recording of joints, a headset, a test.
/// @thread one thread at a time
/// @since 0.1
class HandSource {
 public:
    HandSource() = default;
    HandSource(const HandSource&) = delete;
    HandSource& operator=(const HandSource&) = delete;
    virtual ~HandSource() = default;

    /// Waits up to `timeout` and fills `hands` (interaction frame) when the status is ok; sets
    /// `message` when lost or failed. Stamps never decrease.
    virtual SourceStatus next(Duration timeout, HandFrame& hands, std::string& message) = 0;
};

}  // namespace xtrack
