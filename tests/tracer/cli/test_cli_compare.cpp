// compare from outside, and images of other programs: layers by name, PNG files with their transfer, what info says.
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

/// 4 x 4 pixels of one colour, with that of the layer `albedo` where it has one.
void put(const std::string& file, const vec3& colour, const vec3* albedo = nullptr) {
  std::vector<Channel> channels;
  for (int c = 0; albedo && c < 3; ++c)
    channels.push_back({std::string("albedo.") + "RGB"[c], std::vector<float>(16, (*albedo)[c])});
  writeExr(file, Image{4, 4, std::vector<vec3>(16, colour)}, {}, channels);
}

}  // namespace

TEST_CASE("compare prints every figure, and an exceeded limit gives 1 and says by how much", "[medium]") {
  Folder folder;
  Image a{16, 16, std::vector<vec3>(256, vec3(0.5f))}, b = a;
  for (vec3& pixel : b.pixels) pixel.x += 0.3f;
  writeExr(folder / "a.exr", a, {});
  writeExr(folder / "b.exr", b, {});
  const Ran same = runCopse(folder / "", {"compare", "a.exr", "a.exr", "--max-rmse", "0", "--max-rel-mse", "0"});
  CHECK(same.status == 0);
  for (const char* figure : {"rmse", "rel_mse", "flip", "block_rms"}) CHECK_THAT(same.out, Contains(figure));

  const Ran within = runCopse(folder / "", {"compare", "a.exr", "b.exr", "--max-rmse", "0.2", "--stats", "d.json"});
  CHECK(within.status == 0);
  const nlohmann::json figures = nlohmann::json::parse(bytesOf(folder / "d.json"));
  CHECK(figures["rmse"].get<double>() == Approx(0.3 / std::sqrt(3.0)));
  const Ran over = runCopse(folder / "", {"compare", "a.exr", "b.exr", "--max-rmse", "0.1"});
  CHECK(over.status == 1);
  CHECK_THAT(over.err, Contains("over --max-rmse 0.1 by 0.0732"));
  CHECK(runCopse(folder / "", {"compare", "a.exr", "b.exr", "--max-rel-mse", "0.001"}).status == 1);

  if (hasOpenImageIO()) {
    CHECK(runCopse(folder / "", {"compare", "a.exr", "b.exr", "--heatmap", "h.png"}).status == 0);
    CHECK(std::filesystem::file_size(folder / "h.png") > 60);
  }
  writeExr(folder / "c.exr", Image{8, 8, std::vector<vec3>(64, vec3(0))}, {});
  CHECK(runCopse(folder / "", {"compare", "a.exr", "c.exr"}).status == 2);
  CHECK(runCopse(folder / "", {"compare", "a.exr", "nothing.exr"}).status == 2);
}

TEST_CASE("compare counts the pixels that are not finite, and none pass a limit") {
  Folder folder;
  const Image good{16, 16, std::vector<vec3>(256, vec3(0.5f))};
  Image bad = good;
  for (int i = 0; i < 5; ++i) bad.pixels[i * 40].y = i % 2 ? INFINITY : NAN;
  writeExr(folder / "good.exr", good, {});
  writeExr(folder / "bad.exr", bad, {});
  CHECK_THAT(runCopse(folder / "", {"compare", "good.exr", "good.exr", "--max-rmse", "0"}).out,
             Contains("bad_pixels    0"));
  const Ran told = runCopse(folder / "", {"compare", "bad.exr", "bad.exr", "--stats", "d.json"});
  CHECK(told.status == 0);
  CHECK_THAT(told.out, Contains("bad_pixels    5"));
  CHECK(nlohmann::json::parse(bytesOf(folder / "d.json"))["bad_pixels"] == 5);
  for (const char* other : {"bad.exr", "good.exr"})
    for (const char* limit : {"--max-rmse", "--max-rel-mse"}) {
      const Ran ran = runCopse(folder / "", {"compare", "bad.exr", other, limit, "0"});
      CHECK(ran.status == 1);
      CHECK_THAT(ran.err, Contains("5 pixels are not finite"));
    }
}

TEST_CASE("compare --layer takes the layer of both images, of a reference without layers what there is") {
  const Folder folder;
  const vec3 half(0.5f), quarter(0.25f);
  put(folder / "a.exr", vec3(1), &half);
  put(folder / "b.exr", vec3(2), &half);
  put(folder / "plain.exr", quarter);
  const Ran same = runCopse(folder / "", {"compare", "a.exr", "b.exr", "--layer", "albedo", "--max-rmse", "0"});
  CHECK(same.status == 0);
  CHECK_THAT(same.out, Contains("layer_a       albedo\n") && Contains("layer_b       albedo\n"));
  CHECK(runCopse(folder / "", {"compare", "a.exr", "b.exr", "--max-rmse", "0"}).status == 1);
  for (const bool turned : {false, true}) {
    const Ran other = runCopse(
        folder / "", {"compare", turned ? "plain.exr" : "a.exr", turned ? "a.exr" : "plain.exr", "--layer", "albedo"});
    CHECK(other.status == 0);
    CHECK_THAT(other.out, Contains("rmse          0.25\n") && Contains(turned ? "layer_b " : "layer_a "));
  }
  const Ran none = runCopse(folder / "", {"compare", "a.exr", "b.exr", "--layer", "nothing"});
  CHECK(none.status == 2);
  CHECK_THAT(none.err, Contains("a.exr: no layer 'nothing' (available: (B, G, R), albedo)"));
  CHECK(runCopse(folder / "", {"compare", "plain.exr", "plain.exr", "--layer", "albedo"}).status == 2);
}

TEST_CASE("compare reads a PNG as light and says by which transfer, or says why it cannot") {
  const Folder folder;
  put(folder / "a.exr", vec3(0.21586f));  // 128 of 255 on the curve of sRGB.
  put(folder / "bright.exr", vec3(3));
  if (!hasOpenImageIO()) {
    putBytes(folder / "a.png", "PNG");
    const Ran ran = runCopse(folder / "", {"compare", "a.png", "a.exr"});
    CHECK(ran.status == 2);
    CHECK_THAT(ran.err, Contains("a.png: cannot read this format (only EXR)"));
    return;
  }
  writePng(folder / "a.png", Image{4, 4, std::vector<vec3>(16, vec3(0.21586f))});
  const Ran ran = runCopse(folder / "", {"compare", "a.exr", "a.png", "--max-rmse", "1e-5", "--stats", "s.json"});
  CHECK(ran.status == 0);
  CHECK_THAT(ran.out, Contains("transfer_b    8-bit sRGB, decoded to linear\n"));
  CHECK_THAT(bytesOf(folder / "s.json"), Contains("\"transfer_b\": \"8-bit sRGB, decoded to linear\""));
  CHECK(ran.err.empty());
  const Ran bright = runCopse(folder / "", {"compare", "bright.exr", "a.png"});
  CHECK_THAT(bright.err, Contains("note: bright.exr: 16 pixels are above 1, which a.png cannot hold"));
  CHECK_THAT(runCopse(folder / "", {"info", "a.png"}).out, Contains("4x4 pixels") && Contains("8-bit sRGB"));
}

TEST_CASE("info of an EXR of another program lists its channels") {
  const Folder folder;
  const vec3 albedo(0.5f);
  put(folder / "a.exr", vec3(1), &albedo);
  const Ran ran = runCopse(folder / "", {"info", "a.exr"});
  CHECK(ran.status == 0);
  CHECK_THAT(ran.out, StartsWith("4x4 pixels, without a record of Copse\n"));
  CHECK_THAT(ran.out, Contains("channels  6\n") && Contains("  albedo.G                         float\n"));
}
