// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/paper.hpp"

#include <cmath>
#include <memory>
#include <optional>

#include <utility>

#include <xtrack/paper_decoder.hpp>

#include "core/capture/image_codec.hpp"
#include "tools/bench/scene.hpp"

namespace xtrack::tools::bench {

namespace {

constexpr Size kSize{640, 480};
constexpr double kNear_mm = 600.0;
constexpr double kFar_mm = 820.0;

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

// One whole decode of three images that are not in the cache: phase, unwrapping in space, depth,
// and points where wanted.
class Decoding {
 public:
    static Result<std::shared_ptr<Decoding>> create(const Scene& scene, bool relative, bool points,
                                                    std::shared_ptr<FrameRing> ring) {
        DecodeSettings settings;
        settings.mode = CaptureMode::burst;
        settings.keep_maps = points;
        settings.motion = MotionHandling::off;
        // So much that one order alone is possible: else the wall might be a fringe nearer.
        Rig rig = scene.rig();
        rig.working_volume = WorkingVolume{kNear_mm, kFar_mm};
        auto decoder = PaperDecoder::create(scene.fringes(), scene.size(), settings,
                                            relative ? nullptr : &rig);
        if (!decoder) {
            return decoder.error();
        }
        auto decoding = std::make_shared<Decoding>(*std::move(decoder), std::move(ring));
        decoding->run();  // finds the background, once
        return decoding;
    }
    Decoding(PaperDecoder decoder, std::shared_ptr<FrameRing> ring)
        : decoder_(std::move(decoder)), ring_(std::move(ring)) {}

    void run() noexcept {
        decoder_.reset();
        for (const FramePtr& frame : ring_->next()) {
            (void)decoder_.push(frame);
        }
    }
    [[nodiscard]] const PaperDecoder& decoder() const noexcept { return decoder_; }

 private:
    PaperDecoder decoder_;
    std::shared_ptr<FrameRing> ring_;
};

std::size_t points_of(const PaperDecoder& decoder) {
    std::size_t count = 0;
    const ImageView<const float> points = decoder.points_mm();
    for (int v = 0; v < points.height; ++v) {
        for (int i = 2; i < points.width; i += 3) {
            count += std::isfinite(points.row(v)[i]) ? 1U : 0U;
        }
    }
    return count;
}

}  // namespace

Result<PaperTimes> measure_paper(std::size_t rounds, const std::function<void()>& step) {
    const auto scene = Scene::create(kSize);
    if (!scene) {
        return scene.error();
    }
    const std::vector<Frame> frames = scene->bumpy_frames(scene->fringes());
    const auto reading = Reading::create(frames);
    if (!reading) {
        return reading.error();
    }
    const auto ring = std::make_shared<FrameRing>(frames);
    const auto metric = Decoding::create(*scene, false, true, ring);
    const auto relative = Decoding::create(*scene, true, true, ring);
    const auto plain = Decoding::create(*scene, false, false, ring);
    for (const auto* made : {&metric, &relative, &plain}) {
        if (!*made) {
            return made->error();
        }
    }
    const std::vector<Contender> contenders = {
        {"read", {}, {}, [&] { (*reading)->run(); }},
        {"decode", {}, {}, [&] { (*metric)->run(); }},
        {"decode_relative", {}, {}, [&] { (*relative)->run(); }},
        {"decode_depth", {}, {}, [&] { (*plain)->run(); }}};
    const std::vector<Measured> measured = measure(contenders, rounds, step);
    if ((*reading)->failed()) {
        return *(*reading)->failed();
    }
    PaperTimes times;
    times.read = measured[0].times;
    times.decode = measured[1].times;
    times.decode_relative = measured[2].times;
    times.decode_depth = measured[3].times;
    times.points = points_of((*metric)->decoder());
    times.period_px = scene->fringes().patterns.front().period_px;
    times.depth_error_mm = scene->median_bumpy_error_mm((*metric)->decoder().depth());
    return times;
}

}  // namespace xtrack::tools::bench
