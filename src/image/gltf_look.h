/* gltf_look.h - what a glTF file says of its materials: numbers, and pictures that it holds or that lie beside it.
   Layer 1. glTF 2.0: 3.9 (materials), 3.8 (textures), 4.4 (GLB). Pictures are only fetched here, as bytes; the reader
   process decodes them (image.h), as any stranger's. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

#define WR_GLTF_NAME 64
#define WR_GLTF_PICTURE_MAX ((size_t)256 << 20) /* bytes of one picture */

/* One material. Pictures by their index among the file's images; -1: none. */
typedef struct WrGltfLook {
    char name[WR_GLTF_NAME]; /* cut; may be empty */
    int index, count;        /* which of how many */
    double colour[3], alpha, metalness, roughness, normal_scale;
    int base, facets, normal; /* facets: roughness in G, metalness in B */
    char left
        [400]; /* what it has that a material here has not: "emissive light, occlusion"; or empty */
} WrGltfLook;

/* Read it.
 *
 * which    a number from 1, or a name; NULL: the one that the first triangles have, else the first
 * Errors   name the file: it cannot be read, is no .gltf or .glb, is damaged, has no materials or not that one; a number
 *          is outside its range
 * Threads  any number at once */
bool wr_gltf_look(const char *path, const char *which, WrGltfLook *out, WrError *err);

/* "FILE.glb#2": is it the name of image 2 (from 0) of a glTF file? *length: of the file's part; then *image. */
bool wr_gltf_names_picture(const char *name, size_t *length, int *image);

/* The bytes of an image of the file: out of a buffer, a data: URI, or a file beside or below it. bytes: the caller's. */
bool wr_gltf_picture(const char *path, int image, char **bytes, size_t *length, WrError *err);
