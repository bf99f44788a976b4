/* solid_file.h - a closed body as a file: binary STL and PLY, OBJ. None of them has a unit: that it is the millimetre
   stands where each has room for words.
   Layer 6. Private to this room. */
#pragma once
#include "export/solid.h"

/* Each stretch is read back as it is written. ending: "stl", "ply" or "obj".
 * Errors: another ending, cancelled, anything about the file, which then is as it was. */
bool wr_solid_write(const WrSolid *solid, const char *ending, const char *path, WrError *err);
