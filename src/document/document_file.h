/* document_file.h - the document as one OpenEXR file.
   Layer 5.

   All parts float32, ZIP. Part 0 "F": the composited heights as they are shown, one channel Y, so that every
   program that opens EXR sees the relief. Then for each layer, bottom first: its heights, "layer:NAME" (then
   "layer:NAME (2)" where names repeat; the name itself in wrinkle:layer), its coverage "cover:N" and its
   mask "mask:N" if it has them (N counts layers from 1). Then "selection", if there is one; "colour", the
   scene's colour picture in RGB, if there is one, of several objects "colour:N" for each that has one; "normals",
   likewise, the unit vectors of its normal map; and "mesh", the numbers of its meshes in one channel.

   Attributes of part 0: wrinkle:version (of this format), wrinkle:program, wrinkle:scene (canonical command
   lines; the tolerance's with the dials that were chosen for it), wrinkle:wrap ("periodic", "clamp-u", ...), wrinkle:zero, wrinkle:range, wrinkle:active (number of the
   layer that edits change), wrinkle:solo (of the layer shown alone, 0: none). Of a layer: wrinkle:layer,
   wrinkle:blend, wrinkle:opacity, wrinkle:radius, wrinkle:visible and wrinkle:locked ("on", "off"); of a filter layer,
   whose heights are 0, wrinkle:filter, its operation and values ("blur sigma=3").

   A document of one layer that is F bit for bit, with nothing that needs a part (coverage, mask, selection,
   pictures, mesh), is a file of that one part, with the layer's attributes beside the file's: many programs open
   no file of several parts.

   Version 1 knew layers by name and heights alone, all added; version 2 no file of one part, so that one of
   several is still written as version 2; version 3 no mesh, version 4 no normal map and
   no objects with different meshes, version 5 no surroundings, version 6 no size of the cell,
   solid textures, tone, relief shadows and displaced surfaces, version 7 no pictures of roughness and metalness, occlusion, parallax,
   round lamps, colours of hollows and sheets, version 8 no filter layers. All are read. */
#pragma once
#include "scene/objects.h"
#include "field/wrap.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrScene WrScene;
typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrImageRows WrImageRows;

#define WR_DOCUMENT_VERSION 9
#define WR_DOCUMENT_VERSION_FACETS 8 /* of a file without filter layers */
#define WR_DOCUMENT_VERSION_CELL 7   /* of a file without what came after (format_version.h) */
#define WR_DOCUMENT_VERSION_SURROUND                                                               \
    6 /* of a file without a size of its cell, and what came with it */
#define WR_DOCUMENT_VERSION_OBJECTS 5 /* of a file without surroundings */
#define WR_DOCUMENT_VERSION_MESH 4    /* of a file with one mesh and no normal map */
#define WR_DOCUMENT_VERSION_ALONE 3   /* of a file of one part */
#define WR_DOCUMENT_VERSION_PARTS 2   /* of a file of several parts without a mesh */

/* Names of parts. */
#define WR_DOCUMENT_LAYER "layer:"
#define WR_DOCUMENT_COVER "cover:"
#define WR_DOCUMENT_MASK "mask:"
#define WR_DOCUMENT_SELECTION "selection"
#define WR_DOCUMENT_MESH "mesh"

/* Pictures that an object may have, each in a part of its own. */
typedef enum WrObjectPicture {
    WR_OBJECT_COLOUR,
    WR_OBJECT_NORMALS,
    WR_OBJECT_ROUGHNESS,
    WR_OBJECT_METALNESS,
    WR_OBJECT_SURROUND, /* of the scene: the first object stands for all */
    WR_OBJECT_PICTURES
} WrObjectPicture;
typedef struct WrObjectPictureInfo {
    const char *part; /* "colour" */
    const char *what; /* "colour picture" */
    bool data;        /* its numbers are no colours */
} WrObjectPictureInfo;
extern const WrObjectPictureInfo wr_object_pictures[WR_OBJECT_PICTURES];
/* Borrowed; NULL: it has none. */
WrImage *wr_object_picture(const WrScene *scene, int object, int which);
bool wr_object_any_picture(const WrScene *scene, int which); /* has any object of the scene one? */

/* "periodic", "clamp-u", "clamp-v" or "clamp": the word for the wrap of a table, as in commands. Number i
   clamps u where bit 0 is set, v where bit 1 is; NULL after the last. */
#define WR_DOCUMENT_WRAPS 4
const char *wr_document_wrap_name(int i);
const char *wr_document_wrap_word(WrWrap wrap_u, WrWrap wrap_v);
bool wr_document_wrap_find(const char *word, WrWrap *wrap_u, WrWrap *wrap_v); /* false: no such */

/* Do all texels have the bits of that level? Tiles of such stay unallocated. pitch: floats from row to row. */
bool wr_document_all_at(const float *texels, size_t pitch, int columns, int rows, float level);

/* Save as a whole replacement (base/file.h). scene_text: one canonical command a line. Saving what was
   loaded gives the same bytes. */
bool wr_document_save(const WrDocument *document, const char *scene_text, const char *path,
                      WrError *err);

typedef struct WrLoaded {
    WrDocument *document; /* the scene is the default one: run scene_text to restore it */
    char *scene_text;     /* owned, wr_free */
    WrImage
        *pictures[WR_OBJECTS_MAX][WR_OBJECT_PICTURES]; /* of the scene's objects, or NULL; owned */
    WrImage *mesh; /* embedded mesh (wr_scene_mesh_from_image) or NULL; owned */
    double
        newer_version; /* of the format, where that is newer than ours: parts and settings that we do
                             not know were passed over, so it must not be saved over; else 0 */
} WrLoaded;

/* True if the file is an EXR that carries our version attribute (false also for missing files). */
bool wr_document_recognise(const char *path);
void wr_loaded_free_images(WrLoaded *loaded);
/* Non-finite heights become 0 and are counted in *replaced; coverage, masks and selection are brought to
 * 0..1. Only the layers are read; F is made of them. Outputs are untouched on failure. */
bool wr_document_load(const char *path, WrLoaded *out, int64_t *replaced, WrError *err);

/* Heights from any picture: grey, or Rec. 709 luma of the codes; NaN and infinity became 0 when it was
 * read (image->replaced counts them). The picture is resampled to width x height, each axis by itself: a
 * box filter when shrinking, Catmull-Rom when growing, taps beyond the edge wrapped on a periodic axis
 * and clamped on a clamped one; 0, 0 keeps its own size and exact values. The caller owns the result. */
WrField *wr_import_heights(const WrImage *image, int width, int height, WrWrap wrap_u,
                           WrWrap wrap_v, WrError *err);
/* The same of a picture that is read meanwhile: beside the table little more than a band of its rows is held,
 * unless it grows in height. The rows are used up. */
WrField *wr_import_rows(WrImageRows *rows, int width, int height, WrWrap wrap_u, WrWrap wrap_v,
                        WrError *err);
