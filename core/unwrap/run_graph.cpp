// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/run_graph.hpp"

#include <algorithm>
#include <bit>

#include "core/unwrap/spatial_row.hpp"

namespace xtrack {
namespace {

using Word = StepMaps::Word;

/// A contact this wide is beyond doubt if nearly all of it is sound and most of what lies beside it
/// as well: where the step at a depth edge passes through a whole turn, a stretch of it looks
/// sound.
constexpr int kClearPixels = 8;
constexpr double kClearShare = 0.9;
constexpr double kClearShareBeside = 0.75;

}  // namespace

RunGraph::RunGraph(Size size) : size_(size) {
    const auto pixels =
        static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const int words = (size.width + kWordPixels - 1) / kWordPixels;
    runs_.reserve(pixels);
    forest_.reserve(pixels);
    links_.reserve(2 * pixels);
    first_run_.resize(cell(words, 0) + 1);
}

void RunGraph::build(const StepMaps& maps, double support) {
    runs_.clear();
    forest_.clear();
    links_.clear();
    for (int word = 0; word < maps.words(); ++word) {
        for (int y = 0; y < size_.height; ++y) {
            add_runs(maps, word, y);
            if (y > 0) {
                link_down(maps, word, y - 1);
            }
            link_along(maps, word, y);
        }
    }
    links_.join_all(forest_, support);
}

void RunGraph::add_runs(const StepMaps& maps, int word, int y) {
    const std::size_t at = maps.at(word, y);
    const Word valid = maps.valid[at];
    const Word sound = maps.right_sound[at];
    first_run_[cell(word, y)] = size();
    Word first = valid & ~(sound << 1U);
    // A step out of the word ends a run as well: runs meet there as any neighbours do.
    Word last = valid & ~(sound & bits_below(kWordPixels - 1));
    for (; first != 0; first &= first - 1, last &= last - 1) {
        const Run run{static_cast<std::uint8_t>(std::countr_zero(first)),
                      static_cast<std::uint8_t>(std::countr_zero(last))};
        runs_.push_back(run);
        forest_.add(static_cast<std::uint32_t>(run.pixels()));
    }
    first_run_[cell(word, y) + 1] = size();
}

/// The contacts within a row that end in this word.
void RunGraph::link_along(const StepMaps& maps, int word, int y) {
    const Range here = runs_of(word, y);
    if (here.begin == here.end) {
        return;
    }
    const std::size_t at = maps.at(word, y);
    if (word > 0) {
        const Range left = runs_of(word - 1, y);
        if (left.begin != left.end && runs_[left.end - 1].last == kWordPixels - 1 &&
            runs_[here.begin].first == 0) {
            link_right(maps, left.end - 1, here.begin, at - 1);
        }
    }
    for (std::uint32_t run = here.begin; run + 1 < here.end; ++run) {
        if (runs_[run].last + 1 == runs_[run + 1].first) {
            link_right(maps, run, run + 1, at);
        }
    }
}

/// @param at the word of run a
void RunGraph::link_right(const StepMaps& maps, std::uint32_t a, std::uint32_t b, std::size_t at) {
    const Run left = runs_[a];
    const Word step = Word{1} << left.last;
    const bool sound = (maps.right_sound[at] & step) != 0;
    const bool possible = (maps.right_possible[at] & step) != 0;
    RegionLink link;
    link.a = a;
    link.b = b;
    // From the first pixel to the last, and the step to b.
    link.order = maps.rise_along(at, left.mask());
    link.votes = sound ? kSoundVotes : (possible ? kPossibleVotes : 0);
    link.contact = 1;
    links_.add(forest_, link);
}

/// The contacts of a row with the row below, within a word.
void RunGraph::link_down(const StepMaps& maps, int word, int y) {
    const Range above = runs_of(word, y);
    const Range below = runs_of(word, y + 1);
    int contact = 0, sound = 0;
    for (int near = std::max(word - 1, 0); near <= std::min(word + 1, maps.words() - 1); ++near) {
        contact += maps.below_contact[maps.at(near, y)].pixels;
        sound += maps.below_contact[maps.at(near, y)].sound;
    }
    const bool clear = sound >= kClearShareBeside * contact;
    std::uint32_t a = above.begin;
    std::uint32_t b = below.begin;
    while (a < above.end && b < below.end) {
        if ((runs_[a].mask() & runs_[b].mask()) != 0) {
            link_contact(maps, a, b, maps.at(word, y), clear);
        }
        const bool a_ends = runs_[a].last <= runs_[b].last;
        const bool b_ends = runs_[b].last <= runs_[a].last;
        a += a_ends ? 1U : 0U;
        b += b_ends ? 1U : 0U;
    }
}

/// @param at the word of the upper run
/// @param clear whether the rows touch without a doubt here, as far as can be seen
void RunGraph::link_contact(const StepMaps& maps, std::uint32_t upper, std::uint32_t lower,
                            std::size_t at, bool clear) {
    const std::size_t at_below = at + static_cast<std::size_t>(maps.words());
    Word rest = runs_[upper].mask() & runs_[lower].mask();
    // Within the contact the order changes at residues only, for both runs are whole.
    Word breaks = maps.residue[at] & rest & rest >> 1U;
    // More than half of both runs, so that a run which noise has led from one surface to another
    // is joined to one of them at most.
    const int longer = std::max(runs_[upper].pixels(), runs_[lower].pixels());
    while (rest != 0) {
        const Word piece = breaks != 0 ? rest & (breaks ^ (breaks - 1)) : rest;
        rest &= ~piece;
        breaks &= breaks - 1;
        const Word down = piece & (~piece + 1);
        const Word to_first = down - 1;
        RegionLink link;
        link.a = upper;
        link.b = lower;
        link.order = maps.rise_along(at, runs_[upper].mask() & to_first) +
                     maps.rise_below(at, down) -
                     maps.rise_along(at_below, runs_[lower].mask() & to_first);
        const int sound = count_bits(maps.below_sound[at] & piece);
        const int possible = count_bits(maps.below_possible[at] & piece);
        link.votes = kSoundVotes * static_cast<std::uint32_t>(sound) +
                     kPossibleVotes * static_cast<std::uint32_t>(possible - sound);
        link.contact = static_cast<std::uint32_t>(count_bits(piece));
        if (clear && sound >= kClearPixels && sound >= kClearShare * link.contact &&
            2 * count_bits(piece) > longer) {
            RegionLinks::join(forest_, link);
        } else {
            links_.add(forest_, link);
        }
    }
}

}  // namespace xtrack
