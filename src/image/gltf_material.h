/* gltf_material.h - what a glTF file says of its materials: numbers, and pictures that it holds or that lie beside it.
   glTF 2.0: 3.9 (materials), 3.8 (textures), 4.4 (GLB). Pictures are only fetched here, as bytes; the reader
   process decodes them (image.h), as any stranger's. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

#define WR_GLTF_NAME 64
/* Bytes of one picture, or of the file of its buffer. */
#define WR_GLTF_PICTURE_MAX ((size_t)256 << 20)

/* One material, as the file gives it; what it leaves out has glTF's default. Pictures by their index among the file's
   images, from 0; -1: none. */
typedef struct WrGltfLook {
    char name[WR_GLTF_NAME];     /* any bytes, cut; may be empty */
    int index, count;            /* which, from 0, of how many */
    double colour[3], alpha;     /* baseColorFactor, linear, 0..1 */
    double metalness, roughness; /* 0..1; times the picture's, where there is one */
    double normal_scale;         /* -100..100: of the x and y of the picture's normals */
    int base, normal;            /* colours; normals of tangent space, green up */
    int facets;                  /* roughness in G, metalness in B */
    /* What it has that a material here has not: "emissive light, transparency"; or empty. */
    char left[400];
} WrGltfLook;

/* Read it.
 *
 * which    a name, or else a number from 1; NULL: the one that the first triangles have, else the first
 * Errors   name the file: it cannot be read, is no .gltf or .glb, is damaged, has no materials or not that one; a number
 *          is outside its range
 * Threads  any number at once */
bool wr_gltf_look(const char *path, const char *which, WrGltfLook *out, WrError *err);

/* "FILE.glb#2": is it the name of image 2 (from 0) of a glTF file? *length: of the file's part; then *image. */
bool wr_gltf_names_picture(const char *name, size_t *length, int *image);

/* The bytes of an image of the file: out of a buffer, a data: URI, or a file beside or below it.
 *
 * image    from 0
 * bytes    [*length] the caller's, for wr_free; at least one
 * Errors   name the file: it cannot be read or is damaged, has not that image, the part lies elsewhere or is larger
 *          than WR_GLTF_PICTURE_MAX
 * Threads  any number at once */
bool wr_gltf_picture(const char *path, int image, char **bytes, size_t *length, WrError *err);
