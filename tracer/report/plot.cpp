// The common start of every script, and names beside points.
#include "tracer/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tracer/report/html.h"

namespace copse::report {

namespace {

/// Mean width over the font size; only names are measured by it.
constexpr double letterWidth = 0.61;

}  // namespace

unsigned seriesColor(std::size_t index) {
  static const unsigned colors[] = {0x0072b2, 0xe69f00, 0x009e73, 0xd55e00, 0xcc79a7, 0x56b4e9,
                                    0x666666, 0xbfae00, 0x7a5195, 0x8c564b, 0xb5b9be};
  return colors[index % std::size(colors)];
}

std::string field(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127)
      out += ' ';
    else if (c == '"' || c == '`')
      out += '\'';
    else if (c == '\\')
      out += '/';
    else
      out += c;
  }
  return "\"" + out + "\"";
}

std::string gnuplotString(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127)
      out += ' ';
    else if (c == '\'')
      out += "''";
    else
      out += c;
  }
  return out + "'";
}

std::string number(double value) { return known(value) ? fmt::format("{:.8g}", value) : "NaN"; }

Script::Script(std::string name, int width, int height, const std::string& title)
    : name_(std::move(name)), width_(width), height_(height) {
  text_ = fmt::format(
      "# Draws {0}.svg: gnuplot {0}.gp\n"
      "set encoding utf8\n"
      "set terminal svg size {1},{2} dynamic noenhanced font 'sans-serif,13' background '#ffffff'\n"
      "set output '{0}.svg'\n"
      "set datafile separator \"\\t\"\nset datafile missing 'NaN'\nset datafile commentschars ''\n"
      "set border 3 linecolor rgb '#9aa3ad' linewidth 1\n"
      "set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'\n"
      "set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1\n"
      "set key off\n"
      "set title {3} offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'\n"
      "set xtics offset 0,0.35\n",
      name_, width, height, gnuplotString(title));
}

void Script::margins(int left, int right, int top, int bottom) {
  line(fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", double(left) / width_,
                   1 - double(right) / width_));
  line(fmt::format("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", 1 - double(top) / height_,
                   double(bottom) / height_));
}

void Script::axis(char which, double low, double high, bool logarithmic, const std::string& label) {
  line(fmt::format("set {}range [{:.8g}:{:.8g}]", which, low, high));
  if (logarithmic) line(fmt::format("set logscale {}", which));
  if (!label.empty())
    line(fmt::format("set {}label {} offset {} textcolor rgb '#3c444d' font 'sans-serif,12'", which,
                     gnuplotString(label), which == 'x' ? "0,0.7" : "0.8,0"));
}

void Script::logTics(char which, double low, double high, bool counts) {
  std::vector<double> at;
  // Fewer steps where the range is wide, so that their numbers keep apart.
  const double decades = std::log10(high / low);
  for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10)
    for (const int step : {1, 2, 5}) {
      if (decades > 1.7 && step != 1) continue;
      if (const double value = step * power; value >= low * 0.999 && value <= high * 1.001) at.push_back(value);
    }
  if (decades < 0.9) {  // Too few of those: even steps, as on a linear axis.
    double step = std::pow(10, std::floor(std::log10(high - low)));
    for (const double part : {0.1, 0.2, 0.5, 1.0})
      if ((high - low) / (part * step) <= 8) {
        step *= part;
        break;
      }
    at.clear();
    for (double n = std::ceil(low / step); n * step <= high; ++n) at.push_back(n * step);
  }
  std::string tics;
  for (const double value : at) {
    std::string text = shown(value);
    if (text.find('.') != std::string::npos) {
      while (text.back() == '0') text.pop_back();
      if (text.back() == '.') text.pop_back();
    }
    if (counts && value >= 1e6)
      text = fmt::format("{:g}M", value * 1e-6);
    else if (counts && value >= 1e3)
      text = fmt::format("{:g}k", value * 1e-3);
    tics += fmt::format("{}{} {:.8g}", tics.empty() ? "" : ", ", gnuplotString(text), value);
  }
  if (at.size() > 1) line(fmt::format("set {}tics ({})", which, tics));
}

void Script::data(const std::string& name, const std::vector<std::vector<std::string>>& rows) {
  text_ += "$" + name + " << END_OF_DATA\n";
  for (const std::vector<std::string>& row : rows) text_ += fmt::format("{}\n", fmt::join(row, "\t"));
  text_ += "END_OF_DATA\n";
}

Panel Script::panel(std::string alt, std::string csv) && {
  return {std::move(name_), std::move(alt), std::move(text_), std::move(csv), "", false};
}

void place(std::vector<Label>& labels, const Area& area, double fontSize, const std::vector<Area>& lines) {
  struct Rectangle {
    double left, right, bottom, top;
    double overlap(const Rectangle& other) const {
      const double x = std::min(right, other.right) - std::max(left, other.left);
      const double y = std::min(top, other.top) - std::max(bottom, other.bottom);
      return x > 0 && y > 0 ? x * y : 0;
    }
  };
  std::vector<Rectangle> taken;
  for (const Label& label : labels) taken.push_back({label.x - 5, label.x + 5, label.y - 5, label.y + 5});
  for (const Area& line : lines) taken.push_back({line.left, line.right, line.bottom, line.top});
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Label& label = labels[i];
    if (label.text.empty()) continue;
    const double w = letterWidth * fontSize * static_cast<double>(label.text.size()), h = fontSize;
    double min = 1e30;
    Rectangle best{};
    for (const double far : {8.0, 16.0, 26.0})
      for (const auto& [dx, dy] : {std::pair{1.0, 0.0},
                                   {0.0, 1.0},
                                   {0.0, -1.0},
                                   {-1.0, 0.0},
                                   {0.8, 0.8},
                                   {0.8, -0.8},
                                   {-0.8, 0.8},
                                   {-0.8, -0.8}}) {
        const double cx = label.x + dx * (far + 0.5 * w), cy = label.y + dy * (far + 0.4 * h);
        const Rectangle r{cx - 0.5 * w, cx + 0.5 * w, cy - 0.5 * h, cy + 0.5 * h};
        double bad = far;
        for (std::size_t k = 0; k < taken.size(); ++k)
          if (k != i) bad += 20 * r.overlap(taken[k]);
        bad += 400 * (std::max(0.0, area.left - r.left) + std::max(0.0, r.right - area.right) +
                      std::max(0.0, area.bottom - r.bottom) + std::max(0.0, r.top - area.top));
        if (bad < min) {
          min = bad;
          best = r;
        }
      }
    taken.push_back(best);
    label.left = best.left;
    label.up = 0.5 * (best.bottom + best.top);
  }
}

void draw(Script& script, const std::vector<Label>& labels, int width, int height, double fontSize) {
  for (const Label& label : labels) {
    if (label.text.empty()) continue;
    script.line(
        fmt::format("set label {} at screen {:.5f},{:.5f} left front font 'sans-serif,{:g}' textcolor rgb '#{:06x}'",
                    gnuplotString(label.text), label.left / width, label.up / height, fontSize, label.color));
    // A thin line where a name stands too far off for one to see whose it is.
    const double right = label.left + letterWidth * fontSize * static_cast<double>(label.text.size());
    const double x = std::clamp(label.x, label.left - 2, right + 2);
    const double y = std::clamp(label.y, label.up - 0.5 * fontSize, label.up + 0.5 * fontSize);
    if (label.x > 0 && std::hypot(x - label.x, y - label.y) > 10)
      script.line(
          fmt::format("set arrow from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} nohead back linecolor rgb '#9aa3ad' "
                      "linewidth 0.7",
                      label.x / width, label.y / height, x / width, y / height));
  }
}

unsigned darker(unsigned color) {
  unsigned out = 0;
  for (const int shift : {16, 8, 0}) out |= static_cast<unsigned>(0.62 * (color >> shift & 255)) << shift;
  return out;
}

}  // namespace copse::report
