// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <string>
#include <utility>

#include <xtrack/result.hpp>

namespace xtrack::base {

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

/// Calls `make`, which returns a Result. Memory may run out, and a source may be a caller's own and
/// throw; no exception crosses the public API.
/// @param what is set up, for the message
/// @param culprit where the code of a caller runs in `make`: the words that name it; else null
template <typename Make>
auto setting_up(const char* what, const char* culprit, Make&& make) noexcept -> decltype(make()) {
    const auto thrown = [&](const char* why) {
        return culprit != nullptr ? Error{ErrorCode::invalid_argument,
                                          std::string(what) + ": " + culprit + ": " + why}
                                  : Error{ErrorCode::io, std::string(what) + ": " + why};
    };
    try {
        return std::forward<Make>(make)();
    } catch (const std::bad_alloc&) {
        return out_of_memory(what);
    } catch (const std::exception& e) {
        return thrown(e.what());
    } catch (...) {
        return thrown("something unknown was thrown");
    }
}

/// The same where none but our own code runs.
template <typename Make>
auto setting_up(const char* what, Make&& make) noexcept -> decltype(make()) {
    return setting_up(what, nullptr, std::forward<Make>(make));
}

}  // namespace xtrack::base
