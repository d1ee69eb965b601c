// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstdlib>

#include <png.h>

#include "core/capture/decoders.hpp"

namespace xtrack::capture {

namespace {

/// What libpng's callbacks are given.
struct Reading {
    std::string_view rest;
    bool memory_ran_out = false;
};

[[noreturn]] void give_up(png_structp png, png_const_charp /*why*/) { png_longjmp(png, 1); }

void ignore(png_structp /*png*/, png_const_charp /*why*/) {}

png_voidp reserve(png_structp png, png_alloc_size_t size) {
    void* memory = std::malloc(size);  // NOLINT: libpng is C
    if (memory == nullptr) {
        static_cast<Reading*>(png_get_mem_ptr(png))->memory_ran_out = true;
    }
    return memory;
}

void release(png_structp /*png*/, png_voidp memory) { std::free(memory); }  // NOLINT: as above

void read(png_structp png, png_bytep to, std::size_t count) {
    auto& reading = *static_cast<Reading*>(png_get_io_ptr(png));
    if (count > reading.rest.size()) {
        png_error(png, "torn");
    }
    std::copy_n(reading.rest.begin(), count, to);
    reading.rest.remove_prefix(count);
}

void only_pixels(png_structp png) {
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // all but the critical
    png_set_benign_errors(png, 0);
}

void convert_to(png_structp png, Layout layout, int colour_type) {
    constexpr int kNoMatter = 1;    // whether the colours were grey already
    constexpr double kRed = 0.299;  // luma of BT.601, as OpenCV and JPEG have it
    constexpr double kGreen = 0.587;
    if (layout == Layout::grey16) {
        if (std::endian::native == std::endian::little) {
            png_set_swap(png);
        }
        return;
    }
    png_set_strip_alpha(png);
    if (colour_type == PNG_COLOR_TYPE_PALETTE) {
        png_set_palette_to_rgb(png);
    }
    const bool is_grey = (colour_type & PNG_COLOR_MASK_COLOR) == 0;
    if (layout == Layout::bgr8) {
        if (is_grey) {
            png_set_gray_to_rgb(png);
        }
        png_set_bgr(png);
    } else if (!is_grey) {
        png_set_rgb_to_gray(png, kNoMatter, kRed, kGreen);
    }
}

}  // namespace

// Nothing in it may need a destructor: longjmp() passes them by.
Decoded decode_png(std::string_view bytes, const Rows& out) {
    Reading reading{bytes};
    png_structp png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, nullptr, give_up, ignore,
                                               &reading, reserve, release);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_read_struct(&png, nullptr, nullptr);
        return Decoded::no_memory;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {  // NOLINT: the way out that libpng documents
        png_destroy_read_struct(&png, &info, nullptr);
        return reading.memory_ran_out ? Decoded::no_memory : Decoded::damaged;
    }
    png_set_read_fn(png, &reading, read);
    only_pixels(png);
    png_read_info(png, info);
    convert_to(png, out.layout, png_get_color_type(png, info));
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    const std::size_t row_bytes =
        static_cast<std::size_t>(out.size.width) * bytes_per_pixel(out.layout);
    if (png_get_image_height(png, info) != static_cast<png_uint_32>(out.size.height) ||
        png_get_rowbytes(png, info) != row_bytes) {
        png_error(png, "of another size");
    }
    for (int pass = 0; pass < passes; ++pass) {
        for (int y = 0; y < out.size.height; ++y) {
            png_read_row(png, out.first + static_cast<std::size_t>(y) * out.stride, nullptr);
        }
    }
    png_read_end(png, nullptr);
    png_destroy_read_struct(&png, &info, nullptr);
    return Decoded::whole;
}

}  // namespace xtrack::capture
