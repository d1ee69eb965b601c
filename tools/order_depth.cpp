// SPDX-License-Identifier: Apache-2.0
#include "tools/order_depth.hpp"

#include <set>

#include "core/base/file.hpp"
#include "core/capture/image_codec.hpp"

namespace xtrack::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20U;

}  // namespace

bool stems_repeat(const RecordingReader& recording) {
    std::set<fs::path> stems;
    for (const RecordingEntry& entry : recording.entries()) {
        stems.insert(fs::path(entry.file).stem());
    }
    return stems.size() != recording.entries().size();
}

Result<OrderDepth> OrderDepth::open(const RecordingReader& recording, const std::string& path) {
    OrderDepth order;
    if (path.empty()) {
        return order;
    }
    std::error_code error;
    order.path_ = fs::exists(path, error) ? fs::path(path) : recording.folder() / path;
    if (!fs::exists(order.path_, error)) {
        return Error{ErrorCode::not_found, "--order-from " + path +
                                               ": is not there; give a 16-bit PNG or a folder of "
                                               "them"};
    }
    if (!fs::is_directory(order.path_, error)) {
        order.only_ = order.path_;
        return order;
    }
    std::size_t count = 0;
    for (fs::directory_iterator it(order.path_, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().extension() == ".png") {
            order.only_ = it->path();
            ++count;
        }
    }
    if (count == 0) {
        return Error{ErrorCode::not_found,
                     "--order-from " + path + ": holds no PNG; give a folder of depth images"};
    }
    if (count > 1) {
        if (stems_repeat(recording)) {
            return Error{ErrorCode::unsupported,
                         (recording.folder() / "frames.csv").string() +
                             ": several files have the same name, so that names do not tell which "
                             "depth is whose; rename the files, or give --order-from one image"};
        }
        order.only_.clear();
    }
    return order;
}

Result<const Image<std::uint16_t>*> OrderDepth::of(const RecordingReader& recording,
                                                   std::size_t index) {
    const fs::path file =
        !only_.empty()
            ? only_
            : path_ /
                  fs::path(recording.entries()[index].file).filename().replace_extension(".png");
    if (file != loaded_) {
        const auto bytes = base::read_file(file, kMaxImageBytes);
        if (!bytes) {
            return bytes.error();
        }
        if (auto ok = capture::decode_depth(*bytes, file.string(), recording.image_size(), depth_);
            !ok) {
            return ok.error();
        }
        loaded_ = file;
    }
    return &depth_;
}

}  // namespace xtrack::tools
