// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <string>
#include <utility>

#include <xtrack/result.hpp>

namespace xtrack {

/// The words themselves need memory; where there is none left for them, few must do.
inline Error out_of_memory(const char* what) noexcept {
    try {
        return {ErrorCode::io, std::string(what) +
                                   ": not enough memory; close other programs, or use smaller "
                                   "images"};
    } catch (...) {
        return {ErrorCode::io, "no memory left"};
    }
}

/// Calls `make`, which returns a Result. A source may be a caller's own and throw, and memory may
/// run out; no exception crosses the public API.
template <typename Make>
auto setting_up(const char* what, Make&& make) noexcept -> decltype(make()) {
    try {
        return std::forward<Make>(make)();
    } catch (const std::bad_alloc&) {
        return out_of_memory(what);
    } catch (const std::exception& e) {
        return Error{ErrorCode::invalid_argument,
                     std::string(what) + ": the source threw: " + e.what()};
    } catch (...) {
        return Error{ErrorCode::invalid_argument,
                     std::string(what) + ": the source threw something unknown"};
    }
}

}  // namespace xtrack
