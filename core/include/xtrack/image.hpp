// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>

#include <xtrack/geometry.hpp>

namespace xtrack {

/// Borrowed rows of pixels. `width` counts elements: a BGR image of w pixels has a width of 3 w.
/// @ownership borrows; the Image it came from must outlive it.
/// @since 0.1
template <typename T>
struct ImageView {
    T* data = nullptr;
    int width = 0;
    int height = 0;
    std::ptrdiff_t stride = 0;  ///< elements from one row to the next

    [[nodiscard]] T* row(int y) const noexcept {
        assert(y >= 0 && y < height);
        return data + y * stride;
    }
    [[nodiscard]] T& at(int x, int y) const noexcept {
        assert(x >= 0 && x < width);
        return row(y)[x];
    }
    [[nodiscard]] bool empty() const noexcept { return width == 0 || height == 0; }
    [[nodiscard]] Size size() const noexcept { return {width, height}; }

    operator ImageView<const T>() const noexcept  // NOLINT(google-explicit-constructor)
        requires(!std::is_const_v<T>) {
        return {data, width, height, stride};
    }
};

/// Owned rows of pixels, each row starting on a 64-byte boundary. resize() keeps the memory when
/// the new size fits it, so that a buffer which lives across frames allocates once. Contents after
/// a resize() that changes the size are unspecified; fill() sets them.
/// @since 0.1
template <typename T>
class Image {
    static_assert(std::is_trivially_copyable_v<T>);

 public:
    static constexpr std::size_t kAlignment = 64;

    Image() = default;
    Image(int width, int height) { resize(width, height); }
    Image(int width, int height, T value) {
        resize(width, height);
        fill(value);
    }
    Image(const Image& other) { *this = other; }
    Image& operator=(const Image& other) {
        if (this != &other) {
            resize(other.width_, other.height_);
            for (std::size_t i = 0; i < element_count(); ++i) {
                data_.get()[i] = other.data_.get()[i];
            }
        }
        return *this;
    }
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Image() = default;

    void resize(int width, int height) {
        assert(width >= 0 && height >= 0);
        constexpr std::size_t kPerLine = kAlignment / sizeof(T) > 0 ? kAlignment / sizeof(T) : 1;
        const std::size_t stride =
            (static_cast<std::size_t>(width) + kPerLine - 1) / kPerLine * kPerLine;
        const std::size_t needed = stride * static_cast<std::size_t>(height);
        if (needed > capacity_) {
            data_.reset(static_cast<T*>(
                ::operator new[](needed * sizeof(T), std::align_val_t{kAlignment})));
            capacity_ = needed;
        }
        width_ = width;
        height_ = height;
        stride_ = static_cast<std::ptrdiff_t>(stride);
    }
    void fill(T value) noexcept {
        for (std::size_t i = 0; i < element_count(); ++i) {
            data_.get()[i] = value;
        }
    }

    [[nodiscard]] int width() const noexcept { return width_; }
    [[nodiscard]] int height() const noexcept { return height_; }
    [[nodiscard]] std::ptrdiff_t stride() const noexcept { return stride_; }
    [[nodiscard]] Size size() const noexcept { return {width_, height_}; }
    [[nodiscard]] bool empty() const noexcept { return width_ == 0 || height_ == 0; }
    [[nodiscard]] T* row(int y) noexcept { return view().row(y); }
    [[nodiscard]] const T* row(int y) const noexcept { return view().row(y); }
    [[nodiscard]] T& at(int x, int y) noexcept { return view().at(x, y); }
    [[nodiscard]] const T& at(int x, int y) const noexcept { return view().at(x, y); }
    [[nodiscard]] ImageView<T> view() noexcept { return {data_.get(), width_, height_, stride_}; }
    [[nodiscard]] ImageView<const T> view() const noexcept {
        return {data_.get(), width_, height_, stride_};
    }

    void swap(Image& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(width_, other.width_);
        std::swap(height_, other.height_);
        std::swap(stride_, other.stride_);
        std::swap(capacity_, other.capacity_);
    }

 private:
    struct Free {
        void operator()(T* p) const noexcept {
            ::operator delete[](p, std::align_val_t{kAlignment});
        }
    };
    [[nodiscard]] std::size_t element_count() const noexcept {
        return static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
    }

    std::unique_ptr<T, Free> data_;
    int width_ = 0;
    int height_ = 0;
    std::ptrdiff_t stride_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace xtrack
