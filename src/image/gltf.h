/* gltf.h - packing of a .gltf file with external buffers into one file.

   glTF 2.0, 3.6.1.1 and 5.3 (Buffer): `uri` is a relative path, percent-encoded, or a data: URI. The
   reader process reads a single file. So the program replaces the names of external buffers by their
   bytes in base64, and the reader gets a file that any exporter could have written. Image references
   are unchanged. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_GLTF_PARTS_MAX 64                       /* buffers in external files */
#define WR_GLTF_JSON_MAX ((unsigned long)64 << 20) /* bytes of a .gltf with external buffers */

/* Packs the file at `path` if it is a .gltf with external buffers.
 *
 * out      appended: the packed file; nothing if *packed is false
 * packed   set to true if it was packed. Otherwise the file is complete, or no glTF, which its reader
 *          reports
 * Errors   name the file and the part: its path is not beside or below the file (absolute, "..", a
 *          scheme); unreadable; too many; together larger than a mesh file may be
 * Threads  any number at once */
bool wr_gltf_pack(const char *path, WrText *out, bool *packed, WrError *err);
