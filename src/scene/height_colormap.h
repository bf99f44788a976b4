/* height_colormap.h - colours by height, slope and cavity of a terrain or a table: sand below, meadows
   above, rock on steep slopes, dirt in hollows.

   The result is a colour picture (WrScene.colour), which the renderer and its reference sample like any
   other. Colours are linear. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrPatches WrPatches;

#define WR_STOPS_MAX 16

typedef struct WrStop {
    double height; /* in units of the table or of the terrain's picture */
    double rgb[3];
} WrStop;

/* Source of heights and slopes. */
typedef enum WrHeightColormapOf {
    WR_HEIGHT_COLORMAP_FORM,
    WR_HEIGHT_COLORMAP_TABLE,
    WR_COLOURINGS
} WrHeightColormapOf;
extern const char *const wr_height_colormap_names[WR_COLOURINGS]; /* "form", "table" */

typedef struct WrHeightColormap {
    int count; /* number of stops, lowest first; 0: no colormap */
    WrStop stops[WR_STOPS_MAX];
    bool steep; /* steep slopes have a colour, which appears from slope[0] on and is full from
                   slope[1], degrees */
    double steep_rgb[3], slope[2];
    bool hollow; /* hollows have a colour: places below the Gaussian mean of `within` texels about
                   them */
    double hollow_rgb[3], depth[2],
        within; /* appears from depth[0] on, and is full from depth[1], as heights */
    WrHeightColormapOf of;
    uint64_t key; /* identifies the inputs of the present picture; 0: to be computed */
} WrHeightColormap;

/* Water, sand, meadow, wood, rock and snow over 0..1. */
void wr_height_colormap_default(WrHeightColormap *out);
/* The colour at a height: constant beyond the ends, linear between two stops, a step if two have equal
 * height; on steep slopes blended with their colour by t^2 (3 - 2 t). */
void wr_height_colormap_at(const WrHeightColormap *colouring, double height, double slope_deg,
                           double rgb[3]);
/* The picture for a terrain's patches, covering it once; height: of value 1. */
WrImage *wr_height_colormap_bake_terrain(const WrHeightColormap *colouring, const WrPatches *set,
                                         double height, int w, int h, WrError *err);
/* The picture for a table, texel by texel; its slopes are central differences for the table on a square
 * of one unit. height: of value 1. */
WrImage *wr_height_colormap_table(const WrHeightColormap *colouring, const WrField *field,
                                  double height, WrError *err);
