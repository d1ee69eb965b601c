// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace xtrack {

/// Why a call failed, for programs. People read `Error::message`.
/// @since 0.1
enum class ErrorCode {
    invalid_argument,  ///< the caller's value is out of its documented range
    not_found,         ///< a file, device or part that was named is not there
    io,                ///< the operating system refused to read, to write, or to give memory
    malformed,         ///< outside data breaks its format
    unsupported,       ///< valid, but this build or this method cannot do it
    device_lost,       ///< a device went away while in use
};

/// One line that names the culprit (file, device, caller), the field, and the mend.
/// @since 0.1
struct Error {
    ErrorCode code = ErrorCode::invalid_argument;
    std::string message;
};

/// A value or an Error: what set-up and I/O return. No exception crosses the public API.
/// @since 0.1
template <typename T>
class [[nodiscard]] Result {
 public:
    Result(T value)
        : state_(std::in_place_index<0>, std::move(value)) {
    }  // NOLINT(google-explicit-constructor)
    Result(Error error)
        : state_(std::in_place_index<1>, std::move(error)) {
    }  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return ok(); }

    /// @pre ok()
    [[nodiscard]] T& value() & noexcept { return *pointer(); }
    [[nodiscard]] const T& value() const& noexcept { return *pointer(); }
    [[nodiscard]] T&& value() && noexcept { return std::move(*pointer()); }
    T& operator*() & noexcept { return *pointer(); }
    const T& operator*() const& noexcept { return *pointer(); }
    T&& operator*() && noexcept { return std::move(*pointer()); }
    T* operator->() noexcept { return pointer(); }
    const T* operator->() const noexcept { return pointer(); }

    /// @pre !ok()
    [[nodiscard]] const Error& error() const noexcept {
        assert(!ok());
        return *std::get_if<1>(&state_);
    }

 private:
    T* pointer() noexcept {
        assert(ok());
        return std::get_if<0>(&state_);
    }
    const T* pointer() const noexcept {
        assert(ok());
        return std::get_if<0>(&state_);
    }

    std::variant<T, Error> state_;
};

/// Success or an Error, where there is no value to give.
/// @since 0.1
template <>
class [[nodiscard]] Result<void> {
 public:
    Result() = default;
    Result(Error error)
        : error_(std::move(error)), ok_(false) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const noexcept { return ok_; }
    explicit operator bool() const noexcept { return ok_; }
    /// @pre !ok()
    [[nodiscard]] const Error& error() const noexcept {
        assert(!ok_);
        return error_;
    }

 private:
    Error error_;
    bool ok_ = true;
};

}  // namespace xtrack
