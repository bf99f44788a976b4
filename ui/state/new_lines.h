/* new_lines.h - a new document as the dialog asks for it, in command lines. Tested without a window. */
#pragma once
#include <stdbool.h>

typedef struct WrText WrText;

/* What a new table begins with. */
typedef struct WrStarter {
    const char *label;
    const char *line; /* command, its lengths for a table of 512 texels; NULL: nothing */
} WrStarter;
#define WR_STARTERS 12
extern const WrStarter wr_starters[WR_STARTERS];

/* Sides of a table, as one to the other. */
typedef struct WrAspect {
    const char *label;
    int across, down;
} WrAspect;
#define WR_ASPECTS 6
extern const WrAspect wr_aspects[WR_ASPECTS];

typedef struct WrNewForm {
    double width, height; /* texels */
    int wrap;             /* of wr_document_wrap_name */
    int surface;          /* WrSurfaceKind */
    int starter;          /* of wr_starters */
} WrNewForm;

/* The texels of a table with that aspect (a row of wr_aspects) whose longer side has so many; whole, at least 1. */
void wr_new_sides(int aspect, double longer, double *width, double *height);
/* Can a WrSurfaceKind be offered: it needs no file. */
bool wr_new_surface(int kind);
/* The document's lines, one after the other, each with its end. The cell keeps its shape on the surface as nearly as whole
 * repeats let it. wrap: the word for the form's. Added to out. */
void wr_new_lines(const WrNewForm *form, const char *wrap, WrText *out);
/* The surface of a picture of that size (texels), so that it is seen in its shape; added to out. */
void wr_new_picture_lines(int width, int height, WrText *out);
