/* height_colormap.h - colours that go by height, slope and cavity, of a terrain's form or of a table: sand below, meadows above, rock
   where it is steep, dirt in hollows. They become a colour picture (WrScene.colour), which the renderer and its reference look up as any other.
   Colours are linear. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrImage WrImage;
typedef struct WrPatches WrPatches;

#define WR_STOPS_MAX 16

typedef struct WrStop {
    double height; /* as the table or the terrain's picture has it */
    double rgb[3];
} WrStop;

/* What heights and slopes are of. */
typedef enum WrHeightColormapOf {
    WR_HEIGHT_COLORMAP_FORM,
    WR_HEIGHT_COLORMAP_TABLE,
    WR_COLOURINGS
} WrHeightColormapOf;
extern const char *const wr_height_colormap_names[WR_COLOURINGS]; /* "form", "table" */

typedef struct WrHeightColormap {
    int count; /* of stops, lowest first; 0: there is none */
    WrStop stops[WR_STOPS_MAX];
    bool steep; /* has its colour, which shows from slope[0] on, and alone from slope[1], degrees */
    double steep_rgb[3], slope[2];
    bool
        hollow; /* has its colour: of what lies lower than a Gaussian mean of `within` texels about it */
    double hollow_rgb[3], depth[2],
        within; /* shows from depth[0] on, and alone from depth[1], as heights */
    WrHeightColormapOf of;
    uint64_t key; /* of what the picture was made of; 0: it is to be made */
} WrHeightColormap;

/* Water, sand, meadow, wood, rock and snow over 0..1. */
void wr_height_colormap_default(WrHeightColormap *out);
/* The colour: even beyond the ends, straight between two stops, a step where two have one height; where it is steep mixed
 * with that colour by t^2 (3 - 2 t). */
void wr_height_colormap_at(const WrHeightColormap *colouring, double height, double slope_deg,
                           double rgb[3]);
/* Then, of a place that lies so far below its surroundings: mixed with the colour of hollows in the same way. */
void wr_height_colormap_hollow(const WrHeightColormap *colouring, double below, double rgb[3]);
/* The picture of a terrain's patches, laid once over it; height: what the terrain made of 1. */
WrImage *wr_height_colormap_form(const WrHeightColormap *colouring, const WrPatches *set,
                                 double height, int w, int h, WrError *err);
/* The picture of a table, texel by texel; its slopes are those of central differences where the table lies on a square of
 * one unit. height: of 1. */
WrImage *wr_height_colormap_table(const WrHeightColormap *colouring, const WrField *field,
                                  double height, WrError *err);
