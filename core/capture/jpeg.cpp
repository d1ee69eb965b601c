// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>
// After it: it stands on its types.
#include <jerror.h>

#include "core/capture/decoders.hpp"

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

}  // namespace

// Nothing in it may need a destructor: longjmp() passes them by.
Decoded decode_jpeg(std::string_view bytes, const Rows& out) {
    jpeg_decompress_struct jpeg{};
    Trouble trouble{};
    jpeg.err = jpeg_std_error(&trouble.manager);
    trouble.manager.error_exit = give_up;
    trouble.manager.emit_message = on_message;
    if (setjmp(trouble.back) != 0) {  // NOLINT: the way out that libjpeg documents
        jpeg_destroy_decompress(&jpeg);
        return trouble.manager.msg_code == JERR_OUT_OF_MEMORY ? Decoded::no_memory
                                                              : Decoded::damaged;
    }
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = out.layout == Layout::grey8 ? JCS_GRAYSCALE : JCS_EXT_BGR;
    jpeg_start_decompress(&jpeg);
    const bool fits = jpeg.output_width == static_cast<JDIMENSION>(out.size.width) &&
                      jpeg.output_height == static_cast<JDIMENSION>(out.size.height);
    while (fits && jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = out.first + jpeg.output_scanline * out.stride;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    if (fits) {
        jpeg_finish_decompress(&jpeg);
    }
    jpeg_destroy_decompress(&jpeg);
    return fits ? Decoded::whole : Decoded::damaged;
}

}  // namespace xtrack::capture
