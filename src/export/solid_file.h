/* solid_file.h - a closed body as a file: binary STL and PLY, OBJ. None of them has a unit: that it is the millimetre
   stands where each has room for words.
   Layer 6. Private to this room. */
#pragma once
#include "export/solid.h"

/* ending: "stl", "ply" or "obj". Errors: anything about the file. */
bool wr_solid_write(const WrSolid *solid, const char *ending, const char *path, WrError *err);
