// SPDX-License-Identifier: MIT
// The picture of a trade: a mark for each setting, the greatest error of depth across, the time of a frame upwards.
#include <algorithm>
#include <map>

#include "trade.hpp"

namespace {

constexpr double LEFT = 70, TOP = 60, WIDTH = 620, HEIGHT = 380;

// Errors at this or below, rounding alone, stand at the left border.
constexpr double LEAST_ERROR = 1e-16, MOST_ERROR = 1;

const char *const COLOURS[] = {"#1f5fa8", "#c0392b", "#2e8b57", "#8e44ad", "#d68910",
                               "#16a085", "#7f8c8d", "#a04000", "#2c3e50", "#b03a7e"};

double across(double error) {
    double bounded = std::min(std::max(error, LEAST_ERROR), MOST_ERROR);
    return LEFT + WIDTH * std::log10(bounded / LEAST_ERROR) / std::log10(MOST_ERROR / LEAST_ERROR);
}

class Up {
  public:
    explicit Up(const std::vector<const Measured *> &shown) {
        for (const Measured *m : shown) {
            low_ = std::min(low_, std::floor(std::log10(m->ns)));
            high_ = std::max(high_, std::ceil(std::log10(m->ns)));
        }
    }
    double operator()(double ns) const {
        return TOP + HEIGHT * (high_ - std::log10(ns)) / (high_ - low_);
    }
    int low() const {
        return (int)low_;
    }
    int high() const {
        return (int)high_;
    }

  private:
    double low_ = 3, high_ = 4;
};

// Of ours, those that no other of ours beats in both: by rising error, falling time.
std::vector<const Measured *> front_of(std::vector<const Measured *> shown) {
    std::sort(shown.begin(), shown.end(), [](const Measured *a, const Measured *b) {
        double x = std::max(a->depth, LEAST_ERROR), y = std::max(b->depth, LEAST_ERROR);
        return x != y ? x < y : a->ns < b->ns;
    });
    std::vector<const Measured *> front;
    for (const Measured *m : shown)
        if (m->ours && (front.empty() || m->ns < front.back()->ns))
            front.push_back(m);
    return front;
}

std::string unit_of(int decade) {
    static const char *const names[] = {"1 ns",   "10 ns", "100 ns", "1 us",  "10 us",
                                        "100 us", "1 ms",  "10 ms",  "100 ms"};
    return decade >= 0 && decade <= 8 ? names[decade] : "";
}

void axes(FILE *file, const Up &up) {
    for (int decade = up.low(); decade <= up.high(); decade++) {
        double y = up(std::pow(10, decade));
        std::fprintf(file, "<path d='M%g %.1fh%g' stroke='#ddd'/><text x='%g' y='%.1f' text-anchor='end'>%s</text>\n",
                     LEFT, y, WIDTH, LEFT - 8, y + 4, unit_of(decade).c_str());
    }
    for (int decade = -16; decade <= 0; decade += 2) {
        double x = across(std::pow(10, decade));
        std::fprintf(file,
                     "<path d='M%.1f %gv%g' stroke='#eee'/><text x='%.1f' y='%g' text-anchor='middle'>10"
                     "<tspan dy='-5' font-size='9'>%d</tspan></text>\n",
                     x, TOP, HEIGHT, x, TOP + HEIGHT + 20, decade);
    }
}

} // namespace

void write_picture(FILE *file, const std::string &title, const char *error, const std::vector<Measured> &all) {
    std::vector<const Measured *> shown;
    for (const Measured &m : all)
        if (!std::isnan(m.depth))
            shown.push_back(&m);
    Up up(shown);
    std::fprintf(file,
                 "<svg xmlns='http://www.w3.org/2000/svg' width='860' height='500' font-family='sans-serif' "
                 "font-size='12'>\n<rect width='860' height='500' fill='white'/>\n"
                 "<text x='%g' y='28' font-size='16'>%s</text>\n<text x='%g' y='46' fill='#555'>time of a frame by "
                 "%s; the line is the front of ours</text>\n",
                 LEFT, title.c_str(), LEFT, error);
    axes(file, up);
    std::string path;
    for (const Measured *m : front_of(shown)) {
        char step[64];
        std::snprintf(step, sizeof step, path.empty() ? "M%.1f %.1f" : "H%.1fV%.1f", across(m->depth), up(m->ns));
        path += step;
    }
    std::fprintf(file, "<path d='%sH%g' fill='none' stroke='#1f5fa8' stroke-width='1.5'/>\n", path.c_str(),
                 LEFT + WIDTH);
    std::map<std::string, const char *> colours;
    for (const Measured *m : shown) {
        bool is_new = colours.find(m->family) == colours.end();
        if (is_new) {
            const char *colour = COLOURS[colours.size() % (sizeof COLOURS / sizeof *COLOURS)];
            double y = TOP + 12 + 18 * (double)colours.size();
            colours[m->family] = colour;
            std::fprintf(file, "<circle cx='%g' cy='%g' r='5' fill='%s'/><text x='%g' y='%g'>%s%s</text>\n",
                         LEFT + WIDTH + 20, y, colour, LEFT + WIDTH + 30, y + 4, m->ours ? "ours: " : "",
                         m->family.c_str());
        }
        std::fprintf(file,
                     "<circle cx='%.1f' cy='%.1f' r='4' fill='%s' fill-opacity='0.8'><title>%s %s</title></circle>\n",
                     across(m->depth), up(m->ns), colours[m->family], m->family.c_str(), m->setting.c_str());
    }
    std::fprintf(file, "</svg>\n");
}
