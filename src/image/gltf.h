/* gltf.h - packing of a .gltf file with external buffers into one file.

   glTF 2.0, 3.6.1.1 and 5.3 (Buffer): `uri` is a relative path, percent-encoded, or a data: URI. The
   reader process reads a single file. So the program replaces the names of external buffers by their
   bytes in base64, and the reader gets a file that any exporter could have written. Image references
   are unchanged. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

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

/* ---- materials of a glTF file ---- */

/* Numbers, and embedded or adjacent images. glTF 2.0: 3.9 (materials), 3.8 (textures), 4.4 (GLB). Images are only
   fetched here, as bytes; the reader process decodes them (image.h), like all untrusted images. */

#define WR_GLTF_NAME 64
/* Limit in bytes of one image, or of the file of its buffer. */
#define WR_GLTF_PICTURE_MAX ((size_t)256 << 20)

/* One material of the file; missing values have glTF's defaults. Images are indices into the file's
   images, from 0; -1: none. */
typedef struct WrGltfMaterial {
    char name[WR_GLTF_NAME];     /* any bytes, truncated; may be empty */
    int index, count;            /* index from 0, and the number of materials */
    double colour[3], alpha;     /* baseColorFactor, linear, 0..1 */
    double metalness, roughness; /* 0..1; multiplied by the image's values, if any */
    double normal_scale;         /* -100..100: factor of the x and y of the image's normals */
    int base, normal;            /* colours; tangent-space normals, green up */
    int facets;                  /* roughness in G, metalness in B */
    /* Unsupported properties: "emissive light, transparency"; or empty. */
    char left[400];
} WrGltfMaterial;

/* Reads a material.
 *
 * which    a name, or a number from 1; NULL: that of the first triangles, else the first
 * Errors   name the file: unreadable, no .gltf or .glb, damaged, without materials or that one; a
 *          number is out of range
 * Threads  any number at once */
bool wr_gltf_read_material(const char *path, const char *which, WrGltfMaterial *out, WrError *err);

/* True for the name of an embedded image: "FILE.glb#2" is image 2 (from 0) of a glTF file. *length:
 * length of the file's name; *image: the index. */
bool wr_gltf_names_picture(const char *name, size_t *length, int *image);

/* The bytes of an image of the file: from a buffer, a data: URI, or a file beside or below it.
 *
 * image    from 0
 * bytes    [*length] owned by the caller (wr_free); at least one
 * Errors   name the file: unreadable or damaged, no such image, its path is elsewhere, or it is larger
 *          than WR_GLTF_PICTURE_MAX
 * Threads  any number at once */
bool wr_gltf_picture(const char *path, int image, char **bytes, size_t *length, WrError *err);
