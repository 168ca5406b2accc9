// A small scene on disk for tests of the program: an open box of 12 triangles under a lamp of two, with two views.
#pragma once

#include "tests/support/files.h"

namespace copse::test {

inline const char* const smallObj =
    "mtllib small.mtl\n"
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n"
    "v -0.3 1.9 -0.3\nv 0.3 1.9 -0.3\nv 0.3 1.9 0.3\nv -0.3 1.9 0.3\n"
    "v -0.2 0.5 -0.2\nv 0.2 0.5 -0.2\nv 0.2 0.5 0.2\nv -0.2 0.5 0.2\n"
    "usemtl wall\nf 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 4 1 5 8\nf 5 6 7 8\nf 13 14 15 16\n"
    "usemtl lamp\nf 9 10 11 12\n";

inline const char* const smallMtl = "newmtl wall\nKd 0.7 0.6 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";

inline const char* const smallToml =
    "name = \"small\"\n"
    "[[mesh]]\nfile = \"small.obj\"\n"
    "[[view]]\nname = \"front\"\neye = [0, 1, 3.5]\nat = [0, 1, 0]\nup = [0, 1, 0]\nvfov = 45\n"
    "[[view]]\nname = \"side\"\neye = [0.9, 1, 0.9]\nat = [-1, 1, -1]\nup = [0, 1, 0]\nvfov = 60\n";

/// small.toml, small.obj and small.mtl.
inline void putSmallScene(const Folder& folder) {
  putBytes(folder / "small.obj", smallObj);
  putBytes(folder / "small.mtl", smallMtl);
  putBytes(folder / "small.toml", smallToml);
}

}  // namespace copse::test
