/* solid_file.h - closed mesh file writer: binary STL and PLY, OBJ.
   Private to this module. None of these formats has a unit; a comment in the file states millimetres where the
   format allows it. */
#pragma once
#include "export/solid.h"

/* Writes the file and verifies each part. ending: "stl", "ply" or "obj".
   Errors: another extension, cancelled, any file error; then the old file is unchanged. */
bool wr_solid_write(const WrSolid *solid, const char *ending, const char *path, WrError *err);
