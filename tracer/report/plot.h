// A gnuplot script that carries its own data, so that a figure can be restyled and drawn again from one file.
// One look for all figures: dark text on white, light grid, colours that the colour-blind can tell apart (Okabe and Ito
// 2008; builders' are in builders.h), names beside the marks and no legend box.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tracer/report/page.h"

namespace copse::report {

/// 0xRRGGBB for series that are no builders: iterations' R1 to R4, k, phases. Repeats after the last.
unsigned seriesColor(std::size_t index);

/// Text of the results as a string of gnuplot: in single quotes nothing of it is a command, a macro or a format.
std::string gnuplotString(std::string_view text);
/// The same within a data block, where a tab or the end of a line would break it.
std::string field(std::string_view text);

class Script {
 public:
  /// A drawing of so many units; its files are called `name`.
  Script(std::string name, int width, int height, const std::string& title);

  /// Adds one line.
  void line(const std::string& text) { text_ += text + "\n"; }
  /// The plot's area in units from the left, right, top and bottom edges.
  void margins(int left, int right, int top, int bottom);
  void axis(char which, double low, double high, bool logarithmic, const std::string& label);
  /// Tics at 1, 2, 5 times powers of ten within the range, written as tables write numbers.
  void logTics(char which, double low, double high, bool counts = false);
  /// A block of data, `rows` as made with field() and numbers. Named $name.
  void data(const std::string& name, const std::vector<std::vector<std::string>>& rows);

  /// The panel: script and CSV under `name`.
  Panel panel(std::string alt, std::string csv) &&;

 private:
  std::string name_, text_;
  int width_, height_;
};

/// A name beside a point ("": a point without one, to be kept clear), in a plot's own units; `place` finds a spot for
/// each that covers no other name or point.
struct Label {
  double x, y;  ///< The point in units from the lower left corner of the drawing.
  std::string text;
  unsigned color = 0;
  double left = 0, up = 0;  ///< Where the text starts; found by place().
};
struct Area {
  double left, right, bottom, top;
};
/// `lines`, thin areas, are kept clear as well where there is room.
void place(std::vector<Label>& labels, const Area& area, double fontSize, const std::vector<Area>& lines = {});
/// `set label` for each.
void draw(Script& script, const std::vector<Label>& labels, int width, int height, double fontSize);

/// A colour for text in it: light marks have names that can be read.
unsigned darker(unsigned color);

std::string number(double value);  ///< For a data block.

}  // namespace copse::report
