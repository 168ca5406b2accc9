// The page: one HTML file with its style, figures and images inside, that needs no network and no script.
#pragma once

#include <string>
#include <vector>

#include "tracer/report/aggregate.h"

namespace copse::report {

/// One picture: an SVG file of its own, and the text that goes with it.
struct Panel {
  std::string name;    ///< The stem of its files under figures/.
  std::string alt;     ///< What a reader who cannot see it is told.
  std::string script;  ///< For gnuplot, complete with its data.
  std::string csv;     ///< The same data for other tools.
  std::string svg;     ///< As it goes into the page; "" where it could not be drawn.
  bool wide = false;   ///< Takes a row of its own where there is room for two.
};

/// Panels under one title and one caption.
struct Figure {
  std::string title, caption;  ///< The caption is HTML.
  std::vector<Panel> panels;
};

/// A whole document around `body`.
std::string document(const std::string& title, const std::string& body);

std::string figureHtml(const Figure& figure);

/// The page of one folder. `note` says why there are no figures, where there are none.
std::string pageOf(const Results& results, const std::vector<Figure>& figures, const std::string& note);

/// Sections of their own, in other files.
std::string measuredHtml(const Results& results);
std::string measuredFacts(const Results& results);  ///< Machine, device, compiler, settings alone.
std::string failuresHtml(const Results& results);
std::string parametersHtml(const Results& results);
std::string treesHtml(const Results& results);
std::string raysHtml(const Results& results);
/// Thumbnails that bench left under images/, as data: URIs.
std::string imagesHtml(const Results& results);

}  // namespace copse::report
