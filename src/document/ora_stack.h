/* ora_stack.h - parts of an OpenRaster file: stack.xml as data, and the zip archive.
   Private to this module. */
#pragma once
#include "base/array.h"
#include "base/spool.h"
#include "document/blend.h"
#include "document/document_file.h"
#include "field/ops.h"
#include "scene/objects.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zip.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrText WrText;

/* Texts are owned; NULL if the file does not have the attribute. */
typedef struct WrOraLayer {
    char *name, *src; /* src: the PNG's entry */
    int x, y;         /* of its top left pixel on the canvas; includes the groups' offsets */
    double opacity;   /* 0..1 */
    bool visible, locked, selected;
    int depth;                                                  /* number of groups that it is in */
    bool is_group, collapsed;                                   /* its layers follow, deeper */
    bool passes;                                                /* a group that is not isolated */
    char *operation;                                            /* composite-op */
    char *heights, *cover, *mask, *blend, *radius, *name_bytes; /* our attributes */
    char *filter, *line, *below, *mask_line, *mask_read;        /* our attributes */
    char *own_opacity, *own_visible; /* our attributes, if the standard ones have other values */
    bool on_mask;                    /* our attribute */
} WrOraLayer;

typedef struct WrOraStack {
    int width, height;           /* canvas; unchecked */
    WR_ARRAY(WrOraLayer) layers; /* topmost first */
    int unknown;                 /* number of elements that are neither layers nor groups */
    /* our attributes */
    char *version, *wrap, *active, *solo, *scene, *selection, *mesh,
        *pictures[WR_OBJECTS_MAX][WR_OBJECT_PICTURES];
} WrOraStack;

/* Parses stack.xml. Errors do not name the file. On failure the stack is empty. */
bool wr_ora_stack_read(const char *xml, size_t length, WrOraStack *stack, WrError *err);
void wr_ora_stack_fini(WrOraStack *stack);

/* The nearest composite-op of a blend mode, and the nearest blend mode of a composite-op (*exact: they are
   equivalent for heights). */
const char *wr_ora_operation(WrBlend blend);
WrBlend wr_ora_blend(const char *operation, bool *exact);

/* Appends name="value", escaped, after a space. Characters that XML cannot represent become '?'; false if there
   were any. */
bool wr_ora_add_attribute(WrText *xml, const char *name, const char *value);
void wr_ora_add_float(WrText *xml, const char *name, float value);
void wr_ora_add_filter(WrText *xml, const WrFilter *filter); /* without effect for no filter */
/* Appends the name as an attribute, with hex digits beside it if XML cannot represent it. */
void wr_ora_add_name(WrText *xml, const char *name);
/* Name of the attribute, or of the entry, of an object's picture: PREFIXcolour, PREFIXcolour-2, ... and the
   suffix. */
#define WR_ORA_PICTURE_NAME 64
const char *wr_ora_picture_name(const char *prefix, int object, int which, const char *suffix,
                                char buffer[WR_ORA_PICTURE_NAME]);
/* Format version of the document's file. composite: with a composite layer for other programs. */
int wr_ora_version(const WrDocument *document, bool composite);

/* ---- zip archives: reading of untrusted entries within limits, and output of our own ---- */

typedef struct WrOraZip WrOraZip;

/* Opens an archive. Errors name the file. Writes no files, follows no paths, never waits on a pipe. */
WrOraZip *wr_ora_zip_open(const char *path, WrError *err);
/* Opens an archive from an open file, which it then owns. */
WrOraZip *wr_ora_zip_take(const char *name, int fd, WrError *err);
void wr_ora_zip_close(WrOraZip *zip); /* NULL is fine */

/* Reads one entry, whole, with verified checksum, at most `most` bytes; owned by the caller (wr_free), followed
   by a NUL. */
bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err);

/* Destination of a written archive. */
typedef struct WrOraSink {
    WrByteSink to; /* must be empty */
    int64_t at, end;
    int error; /* errno of the first failure */
} WrOraSink;

/* Creates an archive in the sink, which the library neither opens nor renames. The sink must outlive it. */
zip_t *wr_ora_sink_open(WrOraSink *sink, WrError *err);
