/* ora_stack.h - stack.xml of an OpenRaster file as data.
   Layer 5. Private to this room. */
#pragma once
#include "scene/objects.h"
#include "base/array.h"
#include "document/blend.h"
#include "document/document_file.h"
#include "field/ops.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrText WrText;

/* Texts are owned, NULL where the file has no such attribute. */
typedef struct WrOraLayer {
    char *name, *src; /* src: the PNG's entry */
    int x, y;         /* of its top left pixel on the canvas; groups' offsets added */
    double opacity;   /* 0..1, groups' multiplied in */
    bool visible;     /* and all its groups */
    bool locked, selected;
    char *operation;                                            /* composite-op */
    char *heights, *cover, *mask, *blend, *radius, *name_bytes; /* ours */
    char *filter;                                               /* ours */
    char *own_opacity, *own_visible; /* ours, where others are told otherwise */
    bool on_mask;                    /* ours */
} WrOraLayer;

typedef struct WrOraStack {
    int width, height;           /* canvas; not checked */
    WR_ARRAY(WrOraLayer) layers; /* topmost first */
    int groups;                  /* that were dissolved */
    int unknown;                 /* elements that are neither layers nor groups */
    char *version, *wrap, *active, *solo, *scene, *selection, *mesh,
        *pictures[WR_OBJECTS_MAX][WR_OBJECT_PICTURES]; /* ours */
} WrOraStack;

/* Errors do not name the file. On failure the stack is empty. */
bool wr_ora_stack_read(const char *xml, size_t length, WrOraStack *stack, WrError *err);
void wr_ora_stack_fini(WrOraStack *stack);

/* The nearest composite-op of a blend mode, and the nearest blend mode of a composite-op (*exact: they mean
 * the same as far as heights can). */
const char *wr_ora_operation(WrBlend blend);
WrBlend wr_ora_blend(const char *operation, bool *exact);

/* name="value", escaped, with a space before it. What XML cannot hold becomes '?'; false if there was such. */
bool wr_ora_add_attribute(WrText *xml, const char *name, const char *value);
void wr_ora_add_float(WrText *xml, const char *name, float value);
void wr_ora_add_filter(WrText *xml, const WrFilter *filter); /* nothing of none */
/* The name as an attribute, beside it as hex digits where XML cannot hold it. */
void wr_ora_add_name(WrText *xml, const char *name);
/* The attribute that names the entry of an object's picture, and that entry: PREFIXcolour, PREFIXcolour-2, ... and the
 * suffix. */
#define WR_ORA_PICTURE_NAME 64
const char *wr_ora_picture_name(const char *prefix, int object, int which, const char *suffix,
                                char buffer[WR_ORA_PICTURE_NAME]);
/* Of a file of it. composite: with a layer for others that shows all. */
int wr_ora_version(const WrDocument *document, bool composite);
