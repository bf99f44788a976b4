/* line.h - construction of command lines. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>

typedef struct WrText WrText;

void wr_line_number(WrText *line, const char *name, double value); /* " name=1.5" */
void wr_line_vec(WrText *line, const char *name, WrVec3 value);    /* " name=1,2,3" */
void wr_line_plain_vec(WrText *line, WrVec3 value);                /* "1,2,3" */
/* Append " name="value"" with the quoting of the command language. */
void wr_line_text(WrText *line, const char *name, const char *value);
/* x rounded to `digits` (0..9) after the point, never -0: the precision of a pointer, for readable lines. */
double wr_line_round(double x, int digits);
WrVec3 wr_line_round_vec(WrVec3 v, int digits);

/* ---- command lines for a new document from the values of the dialog ---- */

/* Tested without a window. */

/* Initial content of a new table. */
typedef struct WrStarter {
    const char *label;
    const char *line; /* command with lengths for a table of 512 texels; NULL: none */
} WrStarter;
#define WR_STARTERS 12
extern const WrStarter wr_starters[WR_STARTERS];

/* Aspect ratio of a table. */
typedef struct WrAspect {
    const char *label;
    int across, down;
} WrAspect;
#define WR_ASPECTS 6
extern const WrAspect wr_aspects[WR_ASPECTS];

typedef struct WrNewForm {
    double width, height; /* texels */
    int wrap;             /* index for wr_document_wrap_name */
    int surface;          /* WrSurfaceKind */
    int starter;          /* index into wr_starters */
} WrNewForm;

/* Size in texels of a table with that aspect ratio (a row of wr_aspects) and that longer side; integers, at least
   1. */
void wr_new_sides(int aspect, double longer, double *width, double *height);
/* True if the dialog can offer a WrSurfaceKind: it needs no file. */
bool wr_new_surface(int kind);
/* Append the document's lines, each with its line end. The number of repeats on the surface is the integer that best
 * keeps the cell's shape. wrap: name of the form's edge mode. */
void wr_new_document_lines(const WrNewForm *form, const char *wrap, WrText *out);
/* Append the lines of a surface with the aspect ratio of a picture of that size (texels). */
void wr_new_picture_lines(int width, int height, WrText *out);
