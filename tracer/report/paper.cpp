// The numbers of the paper's Table 1, carried over by hand, and which of them belong to a row of ours.
#include "tracer/report/paper.h"

#include <cmath>
#include <utility>

namespace copse::report {

namespace {

constexpr double none = missing;

// clang-format off
constexpr PaperRow table[] = {
    // scene, 1000 triangles, builder, SAH cost, MRays/s, build ms, ms to image at 8 and at 128 samples per pixel
    {"sponza", 66, "sah", 216, 211, none, 141, 2225},
    {"sponza", 66, "lbvh", 264, 189, 1.8, 154, 2429},
    {"sponza", 66, "hlbvh", 219, 206, 11.7, 154, 2292},
    {"sponza", 66, "atrbvh", 180, 223, 5.4, 139, 2130},
    {"sponza", 66, "kmeans-q1", 229, 200, 2.7, 148, 2341},
    {"sponza", 66, "kmeans-q2", 211, 212, 4.2, 139, 2196},
    {"sponza", 66, "kmeans-q3", 203, 212, 9.0, 143, 2191},
    {"sponza", 66, "kmeans-q4", 198, 224, 30.1, 162, 2121},
    {"sponza", 66, "kmeans-q5", 195, 216, 111, 244, 2238},
    {"sibenik", 75, "sah", 147, 199, none, 176, 2792},
    {"sibenik", 75, "lbvh", 192, 175, 2.1, 202, 3197},
    {"sibenik", 75, "hlbvh", 156, 192, 12.3, 193, 2911},
    {"sibenik", 75, "atrbvh", 138, 209, 6.0, 171, 2663},
    {"sibenik", 75, "kmeans-q1", 177, 184, 3.0, 187, 2957},
    {"sibenik", 75, "kmeans-q2", 165, 190, 4.5, 183, 2888},
    {"sibenik", 75, "kmeans-q3", 158, 190, 9.3, 189, 2895},
    {"sibenik", 75, "kmeans-q4", 150, 201, 33.7, 205, 2756},
    {"sibenik", 75, "kmeans-q5", 147, 199, 117, 291, 2899},
    {"crytek-sponza", 262, "sah", 213, 162, none, 166, 2660},
    {"crytek-sponza", 262, "lbvh", 279, 140, 4.8, 189, 2944},
    {"crytek-sponza", 262, "hlbvh", 225, 155, 14.1, 186, 2764},
    {"crytek-sponza", 262, "atrbvh", 180, 175, 16.6, 167, 2418},
    {"crytek-sponza", 262, "kmeans-q1", 251, 133, 5.7, 201, 3248},
    {"crytek-sponza", 262, "kmeans-q2", 222, 154, 10.2, 180, 2776},
    {"crytek-sponza", 262, "kmeans-q3", 211, 154, 17.8, 190, 2805},
    {"crytek-sponza", 262, "kmeans-q4", 203, 150, 60.2, 237, 2920},
    {"crytek-sponza", 262, "kmeans-q5", 192, 177, 260, 408, 2604},
    {"conference", 331, "sah", 120, 223, none, 214, 3425},
    {"conference", 331, "lbvh", 159, 192, 5.8, 251, 3947},
    {"conference", 331, "hlbvh", 135, 212, 13.5, 242, 3679},
    {"conference", 331, "atrbvh", 93, 239, 20.4, 221, 3223},
    {"conference", 331, "kmeans-q1", 131, 220, 6.8, 230, 3586},
    {"conference", 331, "kmeans-q2", 115, 231, 12.3, 215, 3403},
    {"conference", 331, "kmeans-q3", 102, 240, 22.4, 222, 3299},
    {"conference", 331, "kmeans-q4", 101, 240, none, 275, 3302},
    {"conference", 331, "kmeans-q5", 96, 240, 282, 484, 3525},
    {"happy-buddha", 1087, "sah", 168, 109, none, 118, 1834},
    {"happy-buddha", 1087, "lbvh", 216, 96, 18.9, 151, 2111},
    {"happy-buddha", 1087, "hlbvh", 198, 97, 26.4, 155, 2076},
    {"happy-buddha", 1087, "atrbvh", 180, 105, 67.1, 187, 1961},
    {"happy-buddha", 1087, "kmeans-q1", 227, 97, 21.7, 150, 2080},
    {"happy-buddha", 1087, "kmeans-q2", 213, 102, 36.7, 160, 2008},
    {"happy-buddha", 1087, "kmeans-q3", 207, 100, 61.3, 186, 2062},
    {"happy-buddha", 1087, "kmeans-q4", 207, 98, 147, 275, 2184},
    {"happy-buddha", 1087, "kmeans-q5", 195, 106, 400, 524, 2285},
    {"soda-hall", 2169, "sah", 219, 205, none, 108, 1644},
    {"soda-hall", 2169, "lbvh", 270, 189, 34.2, 146, 1821},
    {"soda-hall", 2169, "hlbvh", 237, 197, 43.2, 151, 1766},
    {"soda-hall", 2169, "atrbvh", 180, 213, 129, 228, 1716},
    {"soda-hall", 2169, "kmeans-q1", 280, 180, 39.0, 156, 1920},
    {"soda-hall", 2169, "kmeans-q2", 250, 190, 69.2, 179, 1832},
    {"soda-hall", 2169, "kmeans-q3", 228, 195, 125, 232, 1847},
    {"soda-hall", 2169, "kmeans-q4", 213, 191, 285, 397, 2050},
    {"soda-hall", 2169, "kmeans-q5", 207, 203, 665, 770, 2333},
    {"hairball", 2880, "sah", 1257, 48, none, 329, 4962},
    {"hairball", 2880, "lbvh", 1290, 45, 46.1, 376, 5322},
    {"hairball", 2880, "hlbvh", 1284, 45, 54.6, 381, 5291},
    {"hairball", 2880, "atrbvh", 1088, 51, 105, 456, 4844},
    {"hairball", 2880, "kmeans-q1", 1324, 38, 52.7, 444, 5946},
    {"hairball", 2880, "kmeans-q2", 1227, 42, 90.0, 447, none},
    {"hairball", 2880, "kmeans-q3", 1197, 41, 169, 529, 6029},
    {"hairball", 2880, "kmeans-q4", 1170, 44, 427, 762, 5860},
    {"hairball", 2880, "kmeans-q5", none, none, none, none, none},
    {"san-miguel", 7880, "sah", none, 116, none, 267, 4056},
    {"san-miguel", 7880, "lbvh", 264, 81, 129, 479, 5803},
    {"san-miguel", 7880, "hlbvh", 204, 96, 142, 443, 4993},
    {"san-miguel", 7880, "atrbvh", 150, 119, 483, none, 4439},
    {"san-miguel", 7880, "kmeans-q1", 264, 90, 163, 473, 5333},
    {"san-miguel", 7880, "kmeans-q2", 226, 104, 302, 576, 4720},
    {"san-miguel", 7880, "kmeans-q3", 201, 108, 551, 820, 4905},
    {"san-miguel", 7880, "kmeans-q4", 187, 120, 1189, 1429, 5058},
    {"san-miguel", 7880, "kmeans-q5", none, none, none, none, none},
    {"power-plant", 12759, "sah", 108, 70, none, 420, 6605},
    {"power-plant", 12759, "lbvh", 132, 61, 200, 682, 8043},
    {"power-plant", 12759, "hlbvh", 120, 65, 214, 670, 7611},
    {"power-plant", 12759, "atrbvh", 84, 69, none, 1151, 7575},
    {"power-plant", 12759, "kmeans-q1", 115, 60, 274, 721, none},
    {"power-plant", 12759, "kmeans-q2", 105, 62, 518, 981, 8132},
    {"power-plant", 12759, "kmeans-q3", 98, 72, 927, 1326, 7382},
    {"power-plant", 12759, "kmeans-q4", 92, 67, 2010, 2467, 9406},
    {"power-plant", 12759, "kmeans-q5", 90, none, none, none, none},
};
// clang-format on

/// Scenes of ours that are the paper's under another name: the plain ones are generators that stand in for them.
constexpr std::pair<const char*, const char*> originals[] = {
    {"lbl-conference", "conference"}, {"laine-hairball", "hairball"}, {"unc-power-plant", "power-plant"}};

const PaperRow* find(const std::string& scene, const std::string& builder) {
  std::string name = scene;
  for (const auto& [ours, papers] : originals)
    if (scene == ours) name = papers;
  for (const PaperRow& row : table)
    if (name == row.scene && builder == row.builder) return &row;
  return nullptr;
}

}  // namespace

std::span<const PaperRow> paperTable() { return table; }

const PaperRow* paperRow(const Scene& scene, const Row& row) {
  if (!isPapersMesh(scene)) return nullptr;
  // A label of the experiment's own, such as kmeans-q2 with another seed, is not the paper's method.
  if (row.ideal) return find(scene.plain, idealBuilder);
  if (row.builder == idealBuilder || row.label != row.builder) return nullptr;
  return find(scene.plain, row.builder);
}

const PaperRow* paperBaseline(const Scene& scene) {
  return isPapersMesh(scene) ? find(scene.plain, baselineBuilder) : nullptr;
}

bool isPapersMesh(const Scene& scene) {
  if (scene.generated) return false;
  if (scene.plain == "san-miguel") return false;  // Most of the model, cut where the count is the paper's.
  const PaperRow* row = find(scene.plain, baselineBuilder);
  return row && known(scene.triangles) && std::abs(scene.triangles / (1e3 * row->thousandTriangles) - 1) <= 0.02;
}

}  // namespace copse::report
