// builder/parallel: the warp's collectives, on 32 fibers and on CUDA, and what happens where lanes part company.
#include <algorithm>
#include <numeric>

#include "builder/base/error.h"
#include "builder/parallel/atomics.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/launch_warps.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

constexpr uint32_t warps = 37;

uint32_t scrambled(uint32_t i) { return i * 2654435761u; }

template <class T>
std::vector<T> numbered(uint32_t n) {
  std::vector<T> values(n);
  for (uint32_t i = 0; i < n; ++i) values[i] = static_cast<T>(scrambled(i) >> 8);
  return values;
}

struct WriteLanes {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    out[index * Warp::size + warp.lane()] = index * 100 + warp.lane();
  }
};

struct Reverse {
  uint32_t* data;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    uint32_t* mine = data + index * Warp::size;
    shared[warp.lane()] = mine[warp.lane()];
    warp.sync();
    mine[warp.lane()] = shared[Warp::size - 1 - warp.lane()];
  }
};

struct Votes {
  const uint32_t* in;
  uint32_t* ballots;
  uint32_t* anyOf;
  HD void operator()(Warp& warp, uint32_t index) const {
    const uint32_t value = in[index * Warp::size + warp.lane()];
    const uint32_t mask = warp.ballot(value & 1);
    ballots[index * Warp::size + warp.lane()] = mask;
    anyOf[index * Warp::size + warp.lane()] = warp.any(value % 32 == 0);
  }
};

struct Particle {
  float position[3];
  uint32_t tag;
  double mass;
};

struct Shuffle {
  Particle* particles;
  uint64_t* words;
  HD void operator()(Warp& warp, uint32_t index) const {
    const uint32_t i = index * Warp::size + warp.lane();
    const Particle particle = warp.shfl(particles[i], warp.lane() + 5);
    const uint64_t word = warp.shfl(words[i], 31 - warp.lane());
    particles[i] = particle;
    words[i] = word;
  }
};

struct Largest {
  HD float operator()(float a, float b) const { return a < b ? b : a; }
};

struct Reductions {
  const float* in;
  float *sums, *largest;
  HD void operator()(Warp& warp, uint32_t index) const {
    const uint32_t i = index * Warp::size + warp.lane();
    sums[i] = warp.reduceAdd(in[i]);
    largest[i] = warp.reduce(in[i], Largest{});
  }
};

struct Ranks {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t) const {
    const bool odd = warp.lane() & 1;
    const uint32_t mask = warp.ballot(odd);
    if (odd) out[warp.rank(mask)] = warp.lane();
  }
};

/// A persistent warp: fetches 32 numbers at a time until none is left.
struct FetchWork {
  uint32_t* next;
  uint32_t n;
  uint32_t* touched;
  HD void operator()(Warp& warp, uint32_t) const {
    for (;;) {
      const uint32_t begin = warp.shfl(warp.lane() == 0 ? atomicAddRelaxed(next, Warp::size) : 0u, 0);
      if (begin >= n) return;
      if (begin + warp.lane() < n) atomicAddRelaxed(&touched[begin + warp.lane()], 1u);
    }
  }
};

struct LeaveEarly {
  uint32_t leaver;
  uint32_t at;
  HD void operator()(Warp& warp, uint32_t index) const {
    warp.sync();
    if (index == at && warp.lane() == leaver) return;
    warp.ballot(true);
  }
};

struct PartCompany {
  HD void operator()(Warp& warp, uint32_t) const {
    if (warp.lane() == 9)
      warp.shfl(1u, 0);
    else
      warp.sync();
  }
};

struct DifferentSizes {
  HD void operator()(Warp& warp, uint32_t) const {
    if (warp.lane() == 3)
      warp.shfl(uint64_t{1}, 0);
    else
      warp.shfl(uint32_t{1}, 0);
  }
};

Device cpuWith(int threads) { return openDevice("cpu", threads); }

std::string messageOf(const auto& call) {
  try {
    call();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("launchWarps calls every lane of every warp once") {
  for (const Device& device : test::devices())
    for (const uint32_t count : {0u, 1u, 2u, 3u, 4u, 5u, 1000u}) {
      Buffer<uint32_t> out(device, count * Warp::size);
      launchWarps(device, "lanes", count, WriteLanes{out.data()});
      const auto host = out.toHost();
      for (uint32_t i = 0; i < host.size(); ++i) REQUIRE(host[i] == i / 32 * 100 + i % 32);
    }
}

TEST_CASE("lanes see each other's shared memory after a sync") {
  for (const Device& device : test::devices()) {
    const auto in = numbered<uint32_t>(warps * Warp::size);
    Buffer<uint32_t> data(device, in);
    launchWarps(device, "reverse", warps, Reverse{data.data()}, Warp::size * sizeof(uint32_t));
    const auto out = data.toHost();
    for (uint32_t i = 0; i < out.size(); ++i) REQUIRE(out[i] == in[i / 32 * 32 + 31 - i % 32]);
  }
}

TEST_CASE("ballot and any count every lane's vote") {
  for (const Device& device : test::devices()) {
    const auto in = numbered<uint32_t>(warps * Warp::size);
    Buffer<uint32_t> values(device, in), ballots(device, in.size()), anyOf(device, in.size());
    launchWarps(device, "votes", warps, Votes{values.data(), ballots.data(), anyOf.data()});
    const auto masks = ballots.toHost(), flags = anyOf.toHost();
    uint32_t seen[2] = {};
    for (uint32_t i = 0; i < in.size(); ++i) {
      uint32_t mask = 0, multiples = 0;
      for (uint32_t lane = 0; lane < 32; ++lane) {
        mask |= (in[i / 32 * 32 + lane] & 1) << lane;
        multiples += in[i / 32 * 32 + lane] % 32 == 0;
      }
      REQUIRE(masks[i] == mask);
      REQUIRE(flags[i] == (multiples ? 1u : 0u));
      ++seen[flags[i]];
    }
    REQUIRE(seen[0] > 0);
    REQUIRE(seen[1] > 0);
  }
}

TEST_CASE("shfl carries words, double words and structs from any lane") {
  for (const Device& device : test::devices()) {
    std::vector<Particle> particles(warps * Warp::size);
    std::vector<uint64_t> words(warps * Warp::size);
    for (uint32_t i = 0; i < words.size(); ++i) {
      particles[i] = {{i + 0.5f, i * 2.0f, -1.0f * i}, i, i * 1e-3};
      words[i] = uint64_t{scrambled(i)} << 32 | i;
    }
    Buffer<Particle> particleBuffer(device, particles);
    Buffer<uint64_t> wordBuffer(device, words);
    launchWarps(device, "shuffle", warps, Shuffle{particleBuffer.data(), wordBuffer.data()});
    const auto movedParticles = particleBuffer.toHost();
    const auto movedWords = wordBuffer.toHost();
    for (uint32_t i = 0; i < words.size(); ++i) {
      const uint32_t from = i / 32 * 32 + (i + 5) % 32;
      REQUIRE(movedParticles[i].tag == from);
      REQUIRE(movedParticles[i].position[2] == particles[from].position[2]);
      REQUIRE(movedParticles[i].mass == particles[from].mass);
      REQUIRE(movedWords[i] == words[i / 32 * 32 + 31 - i % 32]);
    }
  }
}

TEST_CASE("reductions give every lane the result of a loop") {
  for (const Device& device : test::devices()) {
    std::vector<float> in(warps * Warp::size);
    for (uint32_t i = 0; i < in.size(); ++i) in[i] = static_cast<float>(scrambled(i) >> 24) - 100;
    Buffer<float> values(device, in), sums(device, in.size()), largest(device, in.size());
    launchWarps(device, "reductions", warps, Reductions{values.data(), sums.data(), largest.data()});
    const auto gotSums = sums.toHost(), gotLargest = largest.toHost();
    for (uint32_t i = 0; i < in.size(); ++i) {
      const float* mine = in.data() + i / 32 * 32;
      CAPTURE(i);
      REQUIRE(gotSums[i] == std::accumulate(mine, mine + 32, 0.0f));
      REQUIRE(gotLargest[i] == *std::max_element(mine, mine + 32));
    }
  }
}

TEST_CASE("a lane's rank in a ballot is its place among the set lanes") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> out(device, 16);
    launchWarps(device, "ranks", 1, Ranks{out.data()});
    const auto host = out.toHost();
    for (uint32_t i = 0; i < 16; ++i) REQUIRE(host[i] == 2 * i + 1);
  }
}

TEST_CASE("persistent warps share out all work") {
  for (const Device& device : test::devices()) {
    const uint32_t n = 100003;
    Buffer<uint32_t> next(device, 1), touched(device, n);
    next.fill(0);
    touched.fill(0);
    const uint32_t resident = residentWarps<FetchWork>(device);
    REQUIRE(resident > 0);
    launchWarps(device, "fetch", resident, FetchWork{next.data(), n, touched.data()});
    REQUIRE(touched.toHost() == std::vector<uint32_t>(n, 1));
  }
}

TEST_CASE("a lane that leaves while others wait is an error that names launch, warp and lane") {
  for (const int threads : {1, 2}) {
    const Device device = cpuWith(threads);
    for (const uint32_t leaver : {1u, 17u, 31u}) {
      const std::string message = messageOf([&] { launchWarps(device, "early", 8, LeaveEarly{leaver, 5}); });
      REQUIRE(message == "launch 'early', warp 5: lane " + std::to_string(leaver) +
                             " has left the kernel while lane 0 is at a ballot");
    }
    REQUIRE(messageOf([&] {
              launchWarps(device, "early", 8, LeaveEarly{0, 5});
            }) == "launch 'early', warp 5: lane 1 is at a ballot while lane 0 has left the kernel");
  }
}

TEST_CASE("lanes at different collectives are an error") {
  const Device device = cpuWith(2);
  REQUIRE(messageOf([&] { launchWarps(device, "parted", 3, PartCompany{}); }) ==
          "launch 'parted', warp 0: lane 9 is at a shfl of 4 bytes while lane 0 is at a sync");
  REQUIRE(messageOf([&] { launchWarps(device, "sizes", 3, DifferentSizes{}); }) ==
          "launch 'sizes', warp 0: lane 3 is at a shfl of 8 bytes while lane 0 is at a shfl of 4 bytes");
}

TEST_CASE("fibers work as before after a launch that failed") {
  const Device device = cpuWith(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    REQUIRE(messageOf([&] { launchWarps(device, "early", 8, LeaveEarly{3, 1}); }) != "no error");
    Buffer<uint32_t> out(device, 64 * Warp::size);
    launchWarps(device, "lanes", 64, WriteLanes{out.data()});
    REQUIRE(out.read(2047) == 6331);
  }
}
