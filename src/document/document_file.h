/* document_file.h - document file format: one OpenEXR file.

   All parts float32, ZIP. Part 0 "F": the composited heights as displayed, one channel Y, so that every program
   that opens EXR shows the relief. Then for each layer, bottom first: its heights, "layer:NAME" (then
   "layer:NAME (2)" for repeated names; the exact name is in wrinkle:layer), its coverage "cover:N" and its mask
   "mask:N" if it has them (N counts layers from 1). Then "selection", if there is one; "colour", the scene's
   colour picture in RGB, if there is one, with several objects "colour:N" for each that has one; "normals" or
   "normals:N", the unit vectors of normal maps; and "mesh", the numbers of its meshes in one channel.

   Attributes of part 0: wrinkle:version (of this format), wrinkle:program, wrinkle:scene (canonical command
   lines; a tolerance includes the dials chosen for it), wrinkle:wrap ("periodic", "clamp-u", ...), wrinkle:zero,
   wrinkle:range, wrinkle:active (number of the active layer), wrinkle:solo (number of the layer shown alone, 0:
   none). Of a layer: wrinkle:layer, wrinkle:blend, wrinkle:opacity, wrinkle:radius, wrinkle:visible and
   wrinkle:locked ("on", "off"); of a filter layer, whose heights are 0, wrinkle:filter, its operation and values
   ("blur sigma=3"); of a generator layer wrinkle:line, its command line, and wrinkle:below, the hash of the
   composite that the line read; of a layer with a live mask wrinkle:mask-line, its terms, and wrinkle:mask-read, the hash
   of all that they read; of a layer in a group wrinkle:depth, the number of groups that it is in; of a group, whose heights
   are 0 and whose members are the deeper layers directly below, wrinkle:group and wrinkle:collapsed ("on").
   A document with variants has wrinkle:variants, their names, one a line, and wrinkle:variant, the
   name of the one in use; its layers have wrinkle:values, their values in the variants (document/variants.h).

   A document of one layer that equals F bit for bit, without coverage, mask, selection, pictures or mesh, is a
   file of only that part, with the layer's attributes beside the file's: many programs open no file of several
   parts.

   Older versions lack these features, and all can be read:
     1  settings of layers (all are added)          2  files of one part
     3  meshes                                      4  normal maps, objects with different meshes
     5  environments
     6  size of the cell, solid textures, tone, relief shadows, displaced surfaces
     7  roughness and metalness pictures, occlusion, parallax, area lamps, colours of hollows and sheets
     8  filter layers                              11 groups
    12  views of colour configurations
   A file with several parts and none of the later features is still written as version 2. */
#pragma once
#include "field/wrap.h"
#include "scene/objects.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrScene WrScene;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrImageRows WrImageRows;

#define WR_DOCUMENT_VERSION 13
#define WR_DOCUMENT_VERSION_GROUPS 12     /* for a file without a view */
#define WR_DOCUMENT_VERSION_GENERATORS 11 /* for a file without groups and variants */
#define WR_DOCUMENT_VERSION_PROJECTION 10 /* for a file without generator layers */
#define WR_DOCUMENT_VERSION_FILTERS                                                                \
    9                                /* for a file without the features of WR_SCENE_OF_PROJECTION */
#define WR_DOCUMENT_VERSION_FACETS 8 /* for a file without filter layers */
#define WR_DOCUMENT_VERSION_CELL 7   /* for a file without later features (document_file.h) */
#define WR_DOCUMENT_VERSION_SURROUND                                                               \
    6 /* for a file without a cell size and the features introduced with it */
#define WR_DOCUMENT_VERSION_OBJECTS 5 /* for a file without an environment */
#define WR_DOCUMENT_VERSION_MESH 4    /* for a file with one mesh and no normal map */
#define WR_DOCUMENT_VERSION_ALONE 3   /* for a file of one part */
#define WR_DOCUMENT_VERSION_PARTS 2   /* for a file of several parts without a mesh */

/* Names of parts. */
#define WR_DOCUMENT_LAYER "layer:"
#define WR_DOCUMENT_COVER "cover:"
#define WR_DOCUMENT_MASK "mask:"
#define WR_DOCUMENT_SELECTION "selection"
#define WR_DOCUMENT_MESH "mesh"

/* Pictures that an object may have, each stored in its own part. */
typedef enum WrObjectPicture {
    WR_OBJECT_COLOUR,
    WR_OBJECT_NORMALS,
    WR_OBJECT_ROUGHNESS,
    WR_OBJECT_METALNESS,
    WR_OBJECT_SURROUND, /* belongs to the scene: stored for the first object */
    WR_OBJECT_PICTURES
} WrObjectPicture;
typedef struct WrObjectPictureInfo {
    const char *part; /* "colour" */
    const char *what; /* "colour picture" */
    bool data;        /* its numbers are not colours */
} WrObjectPictureInfo;
extern const WrObjectPictureInfo wr_object_pictures[WR_OBJECT_PICTURES];
/* The object's picture, borrowed; NULL: none. */
WrImage *wr_object_picture(const WrScene *scene, int object, int which);
/* true if any object of the scene has one */
bool wr_object_any_picture(const WrScene *scene, int which);

/* "periodic", "clamp-u", "clamp-v" or "clamp": names of a table's wrap, as in commands. Number i clamps u if bit
   0 is set, v if bit 1 is; NULL after the last. */
#define WR_DOCUMENT_WRAPS 4
const char *wr_document_wrap_name(int i);
const char *wr_document_wrap_word(WrWrap wrap_u, WrWrap wrap_v);
/* false: no such name */
bool wr_document_wrap_find(const char *word, WrWrap *wrap_u, WrWrap *wrap_v);

/* True if all texels have the bits of that level. Such tiles are not allocated. pitch: floats from row to row. */
bool wr_document_all_at(const float *texels, size_t pitch, int columns, int rows, float level);

/* Saves by an atomic replacement (base/file.h). scene_text: one canonical command a line. Saving a loaded
   document produces the same bytes, with any number of threads. pool: that compress; NULL: the caller's. */
bool wr_document_save(const WrDocument *document, const char *scene_text, const char *path,
                      WrPool *pool, WrError *err);

typedef struct WrLoaded {
    WrDocument *document; /* the scene is the default one: run scene_text to restore it */
    char *scene_text;     /* owned, wr_free */
    /* of the scene's objects, or NULL; owned */
    WrImage *pictures[WR_OBJECTS_MAX][WR_OBJECT_PICTURES];
    WrImage *mesh; /* embedded mesh (wr_scene_mesh_from_image) or NULL; owned */
    /* version of a file newer than this program, else 0. Unknown parts and settings were ignored, so it must not
       be overwritten */
    double newer_version;
} WrLoaded;

/* True if the file is an EXR with the version attribute (false also for missing files). */
bool wr_document_recognise(const char *path);
void wr_loaded_free_images(WrLoaded *loaded);
/* Loads a document. Non-finite heights become 0 and are counted in *replaced; coverage, masks and selection are
   clamped to 0..1. Only the layers are read; F is computed from them. Outputs are untouched on failure. */
bool wr_document_load(const char *path, WrLoaded *out, int64_t *replaced, WrError *err);

/* Converts a picture to heights: grey, or Rec. 709 luma of the codes; NaN and infinity became 0 when it was read
   (image->replaced counts them). The picture is resampled to width x height, each axis separately: a box filter
   for shrinking, Catmull-Rom for growing, with taps beyond the edge wrapped on a periodic axis and clamped on a
   clamped one; 0, 0 keeps its own size and exact values. The caller owns the result. */
WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err);
/* Converts a picture to heights while it is read: besides the table, memory holds little more than a band of its
   rows, unless its height grows. The rows are consumed. */
WrField *wr_import_rows(WrImageRows *rows, int width, int height, WrWrap wrap_u, WrWrap wrap_v,
                        WrError *err);

/* ---- oldest file version that can hold a scene ---- */

typedef enum WrSceneAge {
    WR_SCENE_OLD,     /* commands of the oldest documents, and features that have their own parts */
    WR_SCENE_OF_CELL, /* the cell's size, solid textures, tone, relief shadows, displacement */
    /* roughness and metalness pictures, occlusion, area lamps, hollows, sheets, frames */
    WR_SCENE_OF_FACETS,
    /* projections, creases, units and masks of meshes; relief over normal maps */
    WR_SCENE_OF_PROJECTION,
    WR_SCENE_OF_VIEW /* of a colour configuration */
} WrSceneAge;

/* The newest feature in the scene that differs from its default in older programs. */
WrSceneAge wr_scene_age(const WrScene *scene);

/* ---- conversion of a scene's picture to float rows, for saving ---- */

/* Copies rows [y, y + rows) with that number of channels: the picture's first ones, or its only one into each.
   out: floats. */
void wr_image_rows_out(const WrImage *image, int channels, int y, int rows, float *out);
