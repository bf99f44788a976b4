/* ora.h - documents as OpenRaster files (*.ora), which other paint programs open as well.
   Layer 5.

   An OpenRaster file is a zip archive: first "mimetype", stored; "stack.xml", the layers, topmost first;
   a 16-bit PNG of each layer under data/; "mergedimage.png", the picture of them all;
   "Thumbnails/thumbnail.png". Those are for others, so that their composite-ops give the picture that ours
   give: grey from black to white over the range of heights that wrinkle:range states, alpha = coverage times
   mask (what adds, subtracts and multiplies is scaled as its operation wants it). The lowest layer that is
   shown is opaque, joined with the ground, and svg:src-over. Where some program would blend the layers to another picture
   (many blend in linear light; no composite-op smooths, filters, or takes factors of heights below 0), a topmost layer
   shows the composite, as mergedimage.png does, and hides the others; this program passes it over. Our own heights lie beside them as float32
   EXR files, named by attributes of the namespace WR_ORA_NAMESPACE, which others pass over:

     image   wrinkle:version  wrinkle:wrap  wrinkle:range  wrinkle:active  wrinkle:solo (layers counted from 1
             at the bottom; 0: none)  wrinkle:scene  wrinkle:selection  wrinkle:colour
             wrinkle:normals (names of entries)
     layer   wrinkle:composite (on: of that topmost layer, and nothing else)
             wrinkle:heights  wrinkle:cover  wrinkle:mask (names of entries)  wrinkle:blend  wrinkle:radius
             wrinkle:name (bytes in hex, where XML cannot hold the name)  wrinkle:opacity  wrinkle:visible (of
             the lowest one and beside a layer that is alone, where others are told otherwise)

   So what we save comes back bit for bit. The same document gives the same bytes.
   Source: OpenRaster baseline specification 0.0.5; PKWARE APPNOTE for the archive. */
#pragma once
#include "document/document_file.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrText WrText;

#define WR_ORA_NAMESPACE "urn:wrinkle:openraster"
#define WR_ORA_VERSION 6
#define WR_ORA_VERSION_FILTERS 5 /* of a file without a composite */
#define WR_ORA_VERSION_FACETS 4  /* of a file without filter layers */
#define WR_ORA_VERSION_CELL 3    /* of a file without what came after (format_version.h) */
#define WR_ORA_VERSION_OBJECTS 2 /* of a file without a size of its cell, and what came with it */
#define WR_ORA_VERSION_PLAIN 1   /* of a file without normal maps or different meshes */

/* Save as a whole replacement (base/file.h). scene_text: one canonical command a line. note: takes a sentence where the file
   holds a composite for others; may be NULL. */
bool wr_ora_save(const WrDocument *document, const char *scene_text, const char *path, WrText *note,
                 WrError *err);

/* Does the file begin like an OpenRaster file? False also for missing files; never waits on a pipe. */
bool wr_ora_recognise(const char *path);

/* Load an OpenRaster file, ours or a stranger's; no file is ever written for it.
 *
 * Of a stranger's file: the table is the canvas, periodic; each layer's heights are the Rec. 709 luma of
 * its codes, 0..1, and its alpha becomes the coverage (none where it is opaque and fills the canvas);
 * what lies outside the canvas is cut off; groups are dissolved, their opacity, visibility and offset
 * going to their layers; composite-op becomes the blend mode that comes nearest.
 *
 * out       as wr_document_load; scene_text is "" for a stranger's file
 * replaced  heights that were not finite and became 0
 * notes     takes one line for each thing that is not as it was in the file; may be NULL
 * Errors    name the file. Outputs are untouched on failure
 * Limits    WR_LAYERS_MAX layers, 16384 pixels a side, 10000 entries, groups 64 deep, no document type and
 *           so no entities, entries stored or deflated by less than 200:1, 2 GB each and 16 GB in all */
bool wr_ora_load(const char *path, WrLoaded *out, int64_t *replaced, WrText *notes, WrError *err);
