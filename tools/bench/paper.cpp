// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/paper.hpp"

#include <memory>
#include <optional>

#include <xtrack/point_cloud.hpp>

#include "core/capture/image_codec.hpp"
#include "tools/bench/ours.hpp"
#include "tools/bench/scene.hpp"

namespace xtrack::tools::bench {

namespace {

constexpr Size kSize{640, 480};

// The three images as a recording holds them. No file is opened: what the disk and the kernel's
// cache of it would add is not ours.
class Reading {
 public:
    static Result<std::shared_ptr<Reading>> create(const std::vector<Frame>& frames) {
        auto reading = std::make_shared<Reading>();
        for (const Frame& frame : frames) {
            auto png = capture::encode_png(frame.pixels.view(), PixelFormat::grey8);
            if (!png) {
                return png.error();
            }
            reading->pngs_.push_back(std::move(*png));
        }
        return reading;
    }

    void run() {
        for (const std::string& png : pngs_) {
            const auto ok = capture::decode_image(png, "image", kSize, PixelFormat::grey8, pixels_);
            if (!ok) {
                failed_ = ok.error();
            }
        }
    }

    [[nodiscard]] const std::optional<Error>& failed() const noexcept { return failed_; }

 private:
    std::vector<std::string> pngs_;
    Image<std::uint8_t> pixels_;
    std::optional<Error> failed_;
};

}  // namespace

Result<PaperTimes> measure_paper(std::size_t rounds, const std::function<void()>& step) {
    const auto scene = Scene::create(kSize);
    if (!scene) {
        return scene.error();
    }
    const std::vector<Frame> frames = scene->frames(scene->three_step());
    const auto reading = Reading::create(frames);
    if (!reading) {
        return reading.error();
    }
    const auto ring = std::make_shared<FrameRing>(frames);
    const auto whole = WholeDecode::create(*scene, scene->three_step(), ring);
    if (!whole) {
        return whole.error();
    }
    Result<PointCloud> cloud = PointCloud{};
    const std::vector<Contender> contenders = {{"read", {}, {}, [&] { (*reading)->run(); }},
                                               {"decode_depth", {}, {}, [&] { (*whole)->run(); }},
                                               {"decode", {}, {}, [&] {
                                                    (*whole)->run();
                                                    cloud = make_point_cloud((*whole)->depth(),
                                                                             scene->rig());
                                                }}};
    const std::vector<Measured> measured = measure(contenders, rounds, step);
    if ((*reading)->failed()) {
        return *(*reading)->failed();
    }
    if (!cloud) {
        return cloud.error();
    }
    return PaperTimes{measured[0].times, measured[2].times, measured[1].times,
                      "one period that is unique in the working volume (the paper: spatial "
                      "unwrapping)",
                      cloud->points_mm.size()};
}

}  // namespace xtrack::tools::bench
