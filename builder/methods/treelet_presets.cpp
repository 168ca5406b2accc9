// The two builders of the literature that are lbvh and then treelets: names for what `--builder lbvh --optimise` says.
#include "builder/method.h"
#include "builder/methods/lbvh.h"

namespace copse::methods {

Method trbvh() {
  return {.name = "trbvh",
          .source = "Karras and Aila 2013",
          .meaning = "lbvh with treelets of seven leaves rebuilt at minimum cost",
          .family = "treelets",
          .page = "docs/builders/trbvh.md",
          .build = buildLbvh,
          .optimisers = {"treelets-exact"}};
}

Method atrbvh() {
  return {.name = "atrbvh",
          .source = "Domingues and Pedrini 2015",
          .meaning = "lbvh with treelets of nine leaves rebuilt by agglomeration",
          .family = "treelets",
          .page = "docs/builders/atrbvh.md",
          .build = buildLbvh,
          .optimisers = {"treelets-agglomerative"}};
}

}  // namespace copse::methods
