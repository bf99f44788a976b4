/* gltf.h - a .gltf file whose buffers stand in files beside it, made one file.
   glTF 2.0, 3.6.1.1 and 5.3 (Buffer): `uri` is a relative path, percent-encoded, or a data: URI.

   The reader process looks at one file alone. So the program itself takes in what the buffers name, as base64 in the place
   of their names, and the reader gets what any exporter could have written. Pictures that are named are left as they are. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_GLTF_PARTS_MAX 64                       /* buffers in files of their own */
#define WR_GLTF_JSON_MAX ((unsigned long)64 << 20) /* bytes of a .gltf that names others */

/* Pack the file at `path` if it is a .gltf with buffers in other files.
 *
 * out      appended: the packed file; nothing where *packed is false
 * packed   set to whether it was one. Else it is whole already, or no glTF at all, of which its reader will tell
 * Errors   name the file and the part: it lies elsewhere than beside or below it (absolute, "..", a scheme); it cannot be
 *          read; there are too many; together they are larger than a mesh file may be
 * Threads  any number at once */
bool wr_gltf_pack(const char *path, WrText *out, bool *packed, WrError *err);
