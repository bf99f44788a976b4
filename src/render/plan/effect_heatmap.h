/* effect_heatmap.h - false-colour map of the effects that ran at each pixel, with its legend
   (WrFrameRequest.map). The hue shows the effects, the lightness the number of samples: from a third to all of
   the hue. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrText WrText;

/* Number of pixels for each value of WrMapBit's bits. */
typedef struct WrHeatmapCounts {
    int64_t of[256];
} WrHeatmapCounts;

/* One row of the legend. */
typedef struct WrHeatmapLine {
    uint8_t rgb[3];
    /* shade: "dark ", "middle " if other pixels took more samples, else ""; colour: "orange" */
    const char *shade, *colour;
    const char *what; /* "bump from filtered slopes" */
    int samples;      /* samples a side, at most; 0: not rendered */
    int64_t pixels;
} WrHeatmapLine;

/* Counts a picture's pixels. */
void wr_heatmap_count(const uint8_t *map, size_t pixels, WrHeatmapCounts *counts);
/* R, G, B for each value of the map, scaled to the picture with these counts. */
void wr_heatmap_colours(const WrHeatmapCounts *counts, uint8_t rgb[256][3]);
/* Row i of the legend; false: there are no more. */
bool wr_heatmap_line(const WrHeatmapCounts *counts, int i, WrHeatmapLine *out);
/* Text of a row: "dark blue"; "bump, up to 4 x 4 samples". */
void wr_heatmap_colour(const WrHeatmapLine *line, WrText *text);
void wr_heatmap_words(const WrHeatmapLine *line, WrText *text);
