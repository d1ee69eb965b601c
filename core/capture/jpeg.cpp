// SPDX-License-Identifier: Apache-2.0
#include "core/capture/jpeg.hpp"

#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

namespace xtrack::capture {

namespace {

/// What libjpeg calls instead of writing to stderr and ending the process.
struct Trouble {
    jpeg_error_mgr manager;  // first: libjpeg hands out a pointer to it
    std::jmp_buf back;
};

[[noreturn]] void give_up(j_common_ptr jpeg) {
    std::longjmp(reinterpret_cast<Trouble*>(jpeg->err)->back, 1);  // NOLINT: libjpeg is C
}

void on_message(j_common_ptr jpeg, int level) {
    if (level < 0) {  // a warning: the data is ruined
        give_up(jpeg);
    }
}

/// Nothing in it may need a destructor: longjmp() passes them by.
bool decode_rows(std::string_view bytes, Size size, J_COLOR_SPACE space, std::uint8_t* out,
                 std::size_t stride) {
    jpeg_decompress_struct jpeg{};
    Trouble trouble{};
    jpeg.err = jpeg_std_error(&trouble.manager);
    trouble.manager.error_exit = give_up;
    trouble.manager.emit_message = on_message;
    if (setjmp(trouble.back) != 0) {  // NOLINT: the way out that libjpeg documents
        jpeg_destroy_decompress(&jpeg);
        return false;
    }
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = space;
    jpeg_start_decompress(&jpeg);
    const bool fits = jpeg.output_width == static_cast<JDIMENSION>(size.width) &&
                      jpeg.output_height == static_cast<JDIMENSION>(size.height);
    while (fits && jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = out + jpeg.output_scanline * stride;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    if (fits) {
        jpeg_finish_decompress(&jpeg);
    }
    jpeg_destroy_decompress(&jpeg);
    return fits;
}

}  // namespace

Result<void> decode_jpeg(std::string_view bytes, const std::string& name, Size size,
                         PixelFormat format, Image<std::uint8_t>& out) {
    const bool grey = format == PixelFormat::grey8;
    out.resize(size.width * (grey ? 1 : 3), size.height);
    if (!decode_rows(bytes, size, grey ? JCS_GRAYSCALE : JCS_EXT_BGR, out.row(0),
                     static_cast<std::size_t>(out.stride()))) {
        return Error{ErrorCode::malformed,
                     name + ": the JPEG is damaged; copy the recording again, or remove its row"};
    }
    return {};
}

}  // namespace xtrack::capture
