// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/eval/canvas.hpp"
#include "tools/pictures.hpp"

namespace xtrack::tools {

namespace {

constexpr int kWidth_px = 1600;
constexpr double kLeft_px = 76.0;  // of the axis
constexpr double kRight_px = kWidth_px - 28.0;
constexpr double kHeader_px = 64.0;
constexpr double kAxis_px = 30.0;
constexpr double kRow_px = 25.0;
constexpr double kBar_px = 19.0;
constexpr double kCommit_px = 4.0;  // of its notch in the bar
constexpr double kBetweenStrips_px = 26.0;
constexpr double kGap_px = 8.0;  // between what stands side by side
constexpr double kDot_px = 5.0;
constexpr double kTick_px = 64.0;       // ticks are at least so far apart
constexpr double kStripSeconds = 20.0;  // a swipe is then as long as its name
constexpr double kMostStrips = 60.0;

// Blue, green, red.
const cv::Scalar kInk(48, 40, 34);
const cv::Scalar kFaint(150, 144, 138);
const cv::Scalar kRule(226, 222, 218);
const cv::Scalar kRight(64, 148, 44);
const cv::Scalar kRightTint(206, 236, 204);
const cv::Scalar kWrong(44, 44, 212);
const cv::Scalar kWrongTint(214, 214, 250);
const cv::Scalar kMissed(0, 120, 235);
const cv::Scalar kCancelled(150, 144, 138);
const cv::Scalar kCancelledTint(228, 225, 222);

/// A stretch of time with a name, and where it is drawn.
struct Mark {
    double from_s = 0.0;
    double to_s = 0.0;
    double at_s = 0.0;  ///< the moment that counts: decided, commit; as from_s where there is none
    std::string name;
    cv::Scalar colour;
    cv::Scalar tint;
    bool hollow = false;
    bool is_event = false;

    double left = 0.0;  ///< px
    double right = 0.0;
    double text_left = 0.0;
    std::size_t row = 0;
};

double seconds(Stamp stamp) { return static_cast<double>(stamp.ns) * 1e-9; }

const char* hand_text(Chirality hand) {
    switch (hand) {
        case Chirality::left: return " L";
        case Chirality::right: return " R";
        case Chirality::unknown: break;
    }
    return "";
}

std::vector<Mark> label_marks(const EvaluatedRecording& r) {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < r.labels.size(); ++i) {
        const GestureLabel& label = r.labels[i];
        const bool found = std::any_of(r.events.begin(), r.events.end(), [i](const JudgedEvent& e) {
            return e.label.has_value() && *e.label == i;
        });
        Mark& mark = marks.emplace_back();
        mark.from_s = seconds(label.start);
        mark.to_s = seconds(label.end);
        mark.at_s = label.commit ? seconds(*label.commit) : mark.from_s;
        mark.name = label.gesture + hand_text(label.hand);
        mark.colour = kFaint;
        mark.tint = kRule;
        if (found) {
            mark.colour = kRight;
            mark.tint = kRightTint;
        } else if (r.scorer.scored(label.gesture)) {
            mark.colour = kMissed;
            mark.hollow = true;
        }
    }
    return marks;
}

std::vector<Mark> event_marks(const EvaluatedRecording& r) {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < r.events.size(); ++i) {
        const JudgedEvent& e = r.events[i];
        Mark& mark = marks.emplace_back();
        mark.is_event = true;
        mark.from_s = seconds(std::min(e.event.onset, e.event.sensor));
        mark.to_s = seconds(e.last);
        mark.at_s = seconds(e.event.sensor);
        mark.name = name_of(e.event) + hand_text(e.event.hand);
        mark.colour = kRight;
        mark.tint = kRightTint;
        if (e.verdict == Verdict::cancelled) {
            mark.colour = kCancelled;
            mark.tint = kCancelledTint;
            mark.name += ", cancelled";
        } else if (is_false(e.verdict)) {
            mark.colour = kWrong;
            mark.tint = kWrongTint;
            mark.name += fmt::format(", {}", to_string(e.verdict));
            mark.name += r.causes[i] == "other" ? "" : ", " + r.causes[i];
        } else if (e.verdict == Verdict::allowed) {
            mark.name += ", allowed";
        }
    }
    return marks;
}

/// A piece of the axis.
struct Strip {
    double from_s = 0.0;
    double to_s = 0.0;

    [[nodiscard]] double x(double s) const {
        return kLeft_px + (s - from_s) / (to_s - from_s) * (kRight_px - kLeft_px);
    }
    [[nodiscard]] double inside(double s) const { return std::clamp(x(s), kLeft_px, kRight_px); }
    [[nodiscard]] bool has(const Mark& mark) const {
        return mark.to_s >= from_s && mark.from_s < to_s;
    }
};

/// Where a mark is drawn in this strip, its name included, wherever there is room for it: in the
/// bar of a label, behind it, or before it at the right edge.
Mark placed(Mark mark, const Strip& strip) {
    const double begin = strip.inside(mark.from_s);
    const double end = std::max(strip.inside(mark.to_s), begin + 2.0);
    const double width = Canvas::text_width(mark.name);
    const double behind = (mark.is_event ? std::max(end, strip.inside(mark.at_s) + kDot_px) : end);
    if (!mark.is_event && width + 1.75 * kGap_px < end - begin) {
        mark.text_left = begin + 0.75 * kGap_px;
    } else if (behind + 0.75 * kGap_px + width <= kRight_px) {
        mark.text_left = behind + 0.75 * kGap_px;
    } else {
        mark.text_left = begin - (mark.is_event ? kDot_px : 0.0) - 0.75 * kGap_px - width;
    }
    mark.left = std::min(begin - (mark.is_event ? kDot_px : 0.0), mark.text_left);
    mark.right = std::max(behind, mark.text_left + width);
    return mark;
}

/// Those that lie in the strip, each in the first row where nothing is in its way.
std::vector<Mark> in_rows(const std::vector<Mark>& marks, const Strip& strip, std::size_t& rows) {
    std::vector<Mark> here;
    for (const Mark& mark : marks) {
        if (strip.has(mark)) {
            here.push_back(placed(mark, strip));
        }
    }
    std::stable_sort(here.begin(), here.end(),
                     [](const Mark& a, const Mark& b) { return a.left < b.left; });
    std::vector<double> taken_to;
    for (Mark& mark : here) {
        while (mark.row < taken_to.size() && taken_to[mark.row] + kGap_px > mark.left) {
            ++mark.row;
        }
        taken_to.resize(std::max(taken_to.size(), mark.row + 1));
        taken_to[mark.row] = mark.right;
    }
    rows = std::max<std::size_t>(taken_to.size(), 1);
    return here;
}

void draw_label(Canvas& canvas, const Mark& mark, const Strip& strip, double middle) {
    const double top = middle - 0.5 * kBar_px;
    const double bottom = middle + 0.5 * kBar_px;
    const double left = strip.inside(mark.from_s);
    const double right = std::max(strip.inside(mark.to_s), left + 2.0);
    canvas.box(left, top, right, bottom, mark.hollow ? cv::Scalar::all(255) : mark.tint,
               Canvas::Fill::solid);
    if (!mark.hollow) {
        canvas.box(left, top, left + 2.0, bottom, mark.colour, Canvas::Fill::solid);
    } else {
        canvas.box(left + 1.0, top + 1.0, right - 1.0, bottom - 1.0, mark.colour,
                   Canvas::Fill::hollow);
    }
    if (mark.at_s > mark.from_s && mark.at_s >= strip.from_s && mark.at_s < strip.to_s) {
        canvas.box(strip.x(mark.at_s) - 1.0, bottom - kCommit_px, strip.x(mark.at_s) + 1.0, bottom,
                   mark.colour, Canvas::Fill::solid);
    }
    canvas.text(mark.text_left, middle + 3.5, mark.name, mark.hollow ? mark.colour : kInk);
}

void draw_event(Canvas& canvas, const Mark& mark, const Strip& strip, double axis, double middle) {
    const double left = strip.inside(mark.from_s);
    const double right = strip.inside(mark.to_s);
    canvas.box(left, middle - 3.0, std::max(right, left + 1.0), middle + 3.0, mark.tint,
               Canvas::Fill::solid);
    if (mark.at_s >= strip.from_s && mark.at_s < strip.to_s) {
        canvas.line(strip.x(mark.at_s), axis - 4.0, strip.x(mark.at_s), axis + 4.0, mark.colour);
        canvas.dot(strip.x(mark.at_s), middle, kDot_px, mark.colour);
    }
    canvas.text(mark.text_left, middle + 4.0, mark.name, mark.colour);
}

/// 1, 2 or 5 times a power of ten, far enough apart to be read.
double tick_step(double px_a_second) {
    double step = 1.0;
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
        step = factor;
        if (step * px_a_second >= kTick_px) {
            break;
        }
    }
    return step;
}

void draw_axis(Canvas& canvas, const Strip& strip, double top, double axis, double bottom) {
    const double step = tick_step((kRight_px - kLeft_px) / (strip.to_s - strip.from_s));
    for (double s = std::ceil(strip.from_s / step) * step; s <= strip.to_s + 1e-9; s += step) {
        canvas.line(strip.x(s), top, strip.x(s), bottom, kRule);
    }
    canvas.line(kLeft_px, axis, kRight_px, axis, kFaint);
    for (double s = std::ceil(strip.from_s / step) * step; s <= strip.to_s + 1e-9; s += step) {
        const std::string text = fmt::format("{:.0f} s", s);
        const double half = 0.5 * Canvas::text_width(text);
        canvas.box(strip.x(s) - half - 3.0, axis + 6.0, strip.x(s) + half + 3.0, axis + 20.0,
                   cv::Scalar::all(255), Canvas::Fill::solid);
        canvas.text(strip.x(s) - half, axis + 17.0, text, kFaint);
    }
}

void draw_legend(Canvas& canvas, double y) {
    struct Entry {
        const char* text;
        cv::Scalar colour;
        cv::Scalar tint;
        enum { bar, hollow, dot } kind;
    };
    const Entry entries[] = {{"label found", kRight, kRightTint, Entry::bar},
                             {"missed", kMissed, {}, Entry::hollow},
                             {"not asked for", kFaint, kRule, Entry::bar},
                             {"event right", kRight, {}, Entry::dot},
                             {"false", kWrong, {}, Entry::dot},
                             {"cancelled", kCancelled, {}, Entry::dot}};
    double x = kRight_px;
    for (const Entry& e : entries) {
        x -= Canvas::text_width(e.text) + 44.0;
    }
    for (const Entry& e : entries) {
        x += 18.0;
        if (e.kind == Entry::dot) {
            canvas.dot(x + 12.0, y - 4.0, kDot_px, e.colour);
        } else {
            canvas.box(x + 1.0, y - 9.0, x + 17.0, y + 1.0,
                       e.kind == Entry::hollow ? e.colour : e.tint,
                       e.kind == Entry::hollow ? Canvas::Fill::hollow : Canvas::Fill::solid);
            canvas.box(x, y - 10.0, x + 2.0, y + 2.0, e.colour, Canvas::Fill::solid);
        }
        canvas.text(x + 22.0, y, e.text, kInk);
        x += 26.0 + Canvas::text_width(e.text);
    }
}

std::string figures(const EvaluatedRecording& r) {
    const GestureScore s = r.scorer.all();
    std::string text = fmt::format("{:.1f} s", r.seconds);
    text += s.labelled > 0 ? fmt::format("   {} of {} found", s.correct, s.labelled)
                           : std::string("   nothing asked for");
    text += fmt::format("   {} false", s.false_events());
    if (s.cancelled > 0) {
        text += fmt::format("   {} cancelled", s.cancelled);
    }
    if (s.labelled > 0) {
        text += fmt::format("   JI {:.2f}", s.jaccard());
    }
    return text;
}

std::string fitted(std::string name) {
    constexpr double kMost_px = 900.0;
    if (Canvas::text_width(name, Canvas::Weight::bold) <= kMost_px) {
        return name;
    }
    while (!name.empty() && Canvas::text_width(name + "...", Canvas::Weight::bold) > kMost_px) {
        name.pop_back();
    }
    return name + "...";
}

std::vector<Strip> strips_of(double from_s, double to_s) {
    const double length = std::max(to_s - from_s, 1.0);
    const double strip = std::max(kStripSeconds, std::ceil(length / kMostStrips));
    const auto count = static_cast<std::size_t>(std::ceil(length / strip));
    std::vector<Strip> strips;
    for (std::size_t i = 0; i < count; ++i) {
        const double begin = from_s + static_cast<double>(i) * strip;
        // One alone has its seconds stretched over the whole width.
        strips.push_back(
            {begin, count == 1 ? begin + std::max(std::ceil(length), 4.0) : begin + strip});
    }
    return strips;
}

}  // namespace

cv::Mat timeline_picture(const EvaluatedRecording& recording) {
    const std::vector<Mark> labels = label_marks(recording);
    const std::vector<Mark> events = event_marks(recording);
    double from_s = seconds(recording.begin);
    double to_s = from_s + recording.seconds;
    for (const std::vector<Mark>& marks : {labels, events}) {
        for (const Mark& mark : marks) {
            from_s = std::min(from_s, mark.from_s);
            to_s = std::max({to_s, mark.to_s, mark.at_s});
        }
    }
    struct Row {
        Strip strip;
        std::vector<Mark> labels;
        std::vector<Mark> events;
        double top = 0.0;
        double axis = 0.0;
        double bottom = 0.0;
    };
    std::vector<Row> rows;
    double y = kHeader_px;
    for (const Strip& strip : strips_of(std::floor(from_s), to_s)) {
        Row& row = rows.emplace_back();
        row.strip = strip;
        std::size_t above = 1;
        std::size_t below = 1;
        row.labels = in_rows(labels, strip, above);
        row.events = in_rows(events, strip, below);
        row.top = y;
        row.axis = y + static_cast<double>(above) * kRow_px + 4.0;
        row.bottom = row.axis + kAxis_px + static_cast<double>(below) * kRow_px;
        y = row.bottom + kBetweenStrips_px;
    }
    Canvas canvas(kWidth_px, static_cast<int>(std::ceil(y)) - 8);
    const std::string name = fitted(recording.name);
    canvas.text(20.0, 30.0, name, kInk, Canvas::Weight::bold);
    canvas.text(20.0, 50.0, figures(recording), kInk);
    draw_legend(canvas, 50.0);
    for (const Row& row : rows) {
        draw_axis(canvas, row.strip, row.top, row.axis, row.bottom);
        canvas.text(20.0, row.axis - 0.5 * kRow_px, "labels", kFaint);
        canvas.text(20.0, row.axis + kAxis_px + 0.5 * kRow_px + 4.0, "events", kFaint);
        for (const Mark& mark : row.labels) {  // the first row is next to the axis
            draw_label(canvas, mark, row.strip,
                       row.axis - 4.0 - (static_cast<double>(mark.row) + 0.5) * kRow_px);
        }
        for (const Mark& mark : row.events) {
            draw_event(canvas, mark, row.strip, row.axis,
                       row.axis + kAxis_px + (static_cast<double>(mark.row) + 0.5) * kRow_px);
        }
    }
    return canvas.finish();
}

Result<TimelineFolder> TimelineFolder::create(const std::filesystem::path& target,
                                              std::size_t recordings) {
    TimelineFolder folder;
    folder.target_ = target;
    folder.is_file_ = target.extension() == ".png";
    if (folder.is_file_ && recordings > 1) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("--timeline {}: is one picture, and there are {} recordings; give "
                                 "a folder",
                                 target.string(), recordings)};
    }
    std::error_code error;
    if (!folder.is_file_ && !std::filesystem::is_directory(target, error) &&
        !std::filesystem::create_directory(target, error)) {
        return Error{ErrorCode::io,
                     fmt::format("--timeline {}: cannot be made; is its parent folder there and "
                                 "writable?",
                                 target.string())};
    }
    return folder;
}

Result<void> TimelineFolder::write(const EvaluatedRecording& recording) {
    const auto before = std::count(names_.begin(), names_.end(), recording.name);
    names_.push_back(recording.name);
    std::string file = recording.name.empty() ? "recording" : recording.name;
    file += before > 0 ? fmt::format("-{}", before + 1) : "";
    return write_png(is_file_ ? target_ : target_ / (file + ".png"), timeline_picture(recording));
}

}  // namespace xtrack::tools
