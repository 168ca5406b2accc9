// The order of the figures.
#include "tracer/report/figures.h"

#include <cctype>

namespace copse::report {

std::string slug(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out.empty() ? "scene" : out;
}

std::vector<Figure> figuresOf(const Results& results) {
  std::vector<Figure> figures;
  for (auto make : {relativeFigure, agreementFigure, scatterFigure, iterationsFigure, phasesFigure, raysFigure,
                    parametersFigure, scalingFigure})
    if (std::optional<Figure> figure = make(results); figure && !figure->panels.empty())
      figures.push_back(std::move(*figure));
  // Two scenes whose names differ in signs alone must not share files.
  for (std::size_t i = 0, number = 0; i < figures.size(); ++i)
    for (Panel& panel : figures[i].panels)
      for (std::size_t k = 0; k <= i; ++k)
        for (const Panel& other : figures[k].panels)
          if (&other != &panel && other.name == panel.name) {
            const std::string from = panel.name + ".svg", to = panel.name + "-" + std::to_string(++number);
            for (std::size_t at; (at = panel.script.find(from)) != std::string::npos;)
              panel.script.replace(at, from.size(), to + ".SVG");
            for (std::size_t at; (at = panel.script.find(".SVG")) != std::string::npos;)
              panel.script.replace(at, 4, ".svg");
            panel.name = to;
          }
  return figures;
}

}  // namespace copse::report
