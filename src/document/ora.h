/* ora.h - documents as OpenRaster files (*.ora), which other paint programs open as well.

   An OpenRaster file is a zip archive: first "mimetype", stored; "stack.xml", the layers, topmost first; a
   16-bit PNG of each layer under data/; "mergedimage.png", the composite;
   "Thumbnails/thumbnail.png". Those are for other programs, so their composite-ops reproduce our result: grey
   from black to white over the range of heights stated in wrinkle:range, alpha = coverage times mask (layers
   that add, subtract and multiply are scaled as their operation needs). The lowest visible layer is opaque,
   combined with the ground, and svg:src-over. If some program would blend the layers to another picture (many
   blend in linear light; no composite-op smooths, filters, or multiplies by heights below 0), a topmost layer
   contains the composite, as mergedimage.png does, and hides the others; so it is if the lowest visible layer is a
   group, since groups lie on nothing there, and for masks of groups; this program ignores it. Our own
   heights are stored beside them as float32 EXR files, named by attributes of the namespace WR_ORA_NAMESPACE,
   which other programs ignore:

     image   wrinkle:version  wrinkle:wrap  wrinkle:range  wrinkle:active  wrinkle:solo (layers counted from 1
             at the bottom; 0: none)  wrinkle:scene  wrinkle:selection  wrinkle:colour
             wrinkle:normals (names of entries)  wrinkle:variants  wrinkle:variant
     layer   wrinkle:composite (on: for that topmost layer, which has no other attribute)
             wrinkle:heights  wrinkle:cover  wrinkle:mask (names of entries)  wrinkle:blend  wrinkle:radius
             wrinkle:name (bytes in hex, if XML cannot represent the name)  wrinkle:opacity  wrinkle:visible (for
             the lowest layer and with a solo layer, if the standard attributes differ)  wrinkle:values
     stack   a group, with the attributes of a layer that it needs, isolation="isolate" and wrinkle:collapsed (on)

   So a saved document is restored bit for bit. The same document produces the same bytes. Source: OpenRaster
   baseline specification 0.0.5; PKWARE APPNOTE for the archive. */
#pragma once
#include "document/document_file.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrText WrText;

#define WR_ORA_NAMESPACE "urn:wrinkle:openraster"
#define WR_ORA_VERSION 10
#define WR_ORA_VERSION_GROUPS 9     /* for a file without a view */
#define WR_ORA_VERSION_GENERATORS 8 /* for a file without groups and variants */
#define WR_ORA_VERSION_PROJECTION 7 /* for a file without generator layers */
#define WR_ORA_VERSION_COMPOSITE 6  /* for a file without projected meshes */
#define WR_ORA_VERSION_FILTERS 5    /* for a file without a composite */
#define WR_ORA_VERSION_FACETS 4     /* for a file without filter layers */
#define WR_ORA_VERSION_CELL 3       /* for a file without later features (document_file.h) */
/* for a file without a cell size and the features introduced with it */
#define WR_ORA_VERSION_OBJECTS 2
#define WR_ORA_VERSION_PLAIN 1 /* for a file without normal maps or different meshes */

/* Saves by an atomic replacement (base/file.h). scene_text: one canonical command a line. note: receives a
   sentence if the file contains a composite for other programs; may be NULL. */
bool wr_ora_save(const WrDocument *document, const char *scene_text, const char *path, WrText *note,
                 WrError *err);

/* True if the file begins like an OpenRaster file. False also for missing files; never waits on a pipe. */
bool wr_ora_recognise(const char *path);

/* Loads an OpenRaster file, written by this program or another; writes no files.

   For a file of another program: the table is the canvas, periodic; each layer's heights are the Rec. 709 luma
   of its codes, 0..1, and its alpha becomes the coverage (none if it is opaque and fills the canvas); areas
   outside the canvas are cropped; the offsets of groups are applied to their layers; composite-op becomes the nearest
   blend mode.

   out       as wr_document_load; scene_text is "" for a file of another program
   replaced  heights that were not finite and became 0
   notes     receives one line for each property that could not be kept; may be NULL Errors    name the file.
   Outputs are untouched on failure
   Limits    WR_LAYERS_MAX layers, 16384 pixels a side, 10000 entries, groups WR_DEPTH_MAX deep, no document type and
             so no entities, entries stored or deflated by less than 200:1, 2 GB each and 16 GB in all */
bool wr_ora_load(const char *path, WrLoaded *out, int64_t *replaced, WrText *notes, WrError *err);
