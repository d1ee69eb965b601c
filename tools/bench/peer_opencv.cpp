// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/phase_unwrapping.hpp>
#include <opencv2/structured_light.hpp>

#include "tools/bench/peers.hpp"

namespace xtrack::tools::bench {

std::optional<Contender> opencv_peer(const Scene& scene, std::shared_ptr<FrameRing> ring) {
    namespace sl = cv::structured_light;
    cv::setNumThreads(1);
    const PatternSequence& patterns = scene.three_step();
    auto parameters = cv::makePtr<sl::SinusoidalPattern::Params>();
    parameters->width = patterns.projector_size.width;
    parameters->height = patterns.projector_size.height;
    parameters->nbrOfPeriods =
        static_cast<int>(patterns.projector_size.width / patterns.patterns.front().period_px);
    parameters->methodId = sl::PSP;
    parameters->setMarkers = false;
    const auto pattern = sl::SinusoidalPattern::create(parameters);
    return Contender{"opencv_contrib", {}, {}, [pattern, ring = std::move(ring)] {
                         std::vector<cv::Mat> images;
                         for (const FramePtr& frame : ring->next()) {
                             // OpenCV has no const image header; it only reads these.
                             images.emplace_back(frame->height(), frame->width(), CV_8UC1,
                                                 const_cast<std::uint8_t*>(frame->pixels.row(0)),
                                                 static_cast<std::size_t>(frame->pixels.stride()));
                         }
                         cv::Mat wrapped;
                         cv::Mat mask;
                         cv::Mat unwrapped;
                         pattern->computePhaseMap(images, wrapped, mask);
                         pattern->unwrapPhaseMap(wrapped, unwrapped, wrapped.size(), mask);
                     }};
}

}  // namespace xtrack::tools::bench
