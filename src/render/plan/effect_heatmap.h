/* effect_heatmap.h - where each effect ran: what each pixel of a picture took (WrFrameRequest.map), in false colours and in words.
   Layer 5. The hue tells what ran, the lightness how many samples were taken: from a third to all of the hue. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrText WrText;

/* How many pixels took what: by WrMapBit's bits. */
typedef struct WrHeatmapCounts {
    int64_t of[256];
} WrHeatmapCounts;

/* A line of the legend. */
typedef struct WrHeatmapLine {
    uint8_t rgb[3];
    const char *shade,
        *colour; /* "dark ", "middle " where more samples were taken elsewhere, else ""; "orange" */
    const char *what; /* "bump from filtered slopes" */
    int samples;      /* a side, at most; 0: not rendered */
    int64_t pixels;
} WrHeatmapLine;

/* Count a picture's pixels. */
void wr_heatmap_count(const uint8_t *map, size_t pixels, WrHeatmapCounts *counts);
/* The colour of each value of the map, R, G, B: of a picture in which these are. */
void wr_heatmap_colours(const WrHeatmapCounts *counts, uint8_t rgb[256][3]);
/* Line i of those that are there; false: there are no more. */
bool wr_heatmap_line(const WrHeatmapCounts *counts, int i, WrHeatmapLine *out);
/* "dark blue"; "bump, up to 4 x 4 samples" */
void wr_heatmap_colour(const WrHeatmapLine *line, WrText *text);
void wr_heatmap_words(const WrHeatmapLine *line, WrText *text);
