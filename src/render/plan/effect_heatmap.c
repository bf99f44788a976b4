#include "render/plan/effect_heatmap.h"

#include "base/text.h"
#include "render/frame/frame.h"

#include <stdio.h>

typedef struct Hue {
    int mask, bits;
    const char *what, *colour;
    uint8_t rgb[3];
} Hue;

/* The first row whose bits match applies.
   A byte of the map: the lower bits tell the work (WR_MAP_), the upper ones log2 of the samples along a
   pixel's side. mask selects bits, all of which must equal `bits`. */
static const Hue hues[] = {
    { WR_MAP_RENDERED, 0, "not rendered: unchanged", "black", { 0, 0, 0 } },
    { WR_MAP_COVERED, 0, "outside the object", "slate", { 96, 96, 128 } },
    { WR_MAP_LIT, 0, "ambient light alone", "violet", { 160, 96, 192 } },
    { WR_MAP_LOOKED | WR_MAP_WIDE,
      WR_MAP_WIDE,
      "light and filtered colour, no bump",
      "yellow",
      { 240, 224, 64 } },
    { WR_MAP_LOOKED, 0, "light, no bump", "grey", { 224, 224, 224 } },
    { WR_MAP_WIDE, WR_MAP_WIDE, "bump from filtered slopes", "orange", { 255, 128, 0 } },
    { 0, 0, "bump", "blue", { 0, 200, 255 } },
};

#define LEVELS (256 / WR_MAP_SAMPLES)

static const Hue *hue_of(int bits)
{
    const Hue *hue = hues;
    while ((bits & hue->mask) != hue->bits) hue++;
    return hue;
}

static int last_level(const WrHeatmapCounts *counts)
{
    int last = 0;
    for (int b = 0; b < 256; b++)
        if (counts->of[b] > 0 && b / WR_MAP_SAMPLES > last) last = b / WR_MAP_SAMPLES;
    return last;
}

/* Full brightness for the largest number of samples in the picture.
   Brightness (last + 2 level) / (3 last): a third at one sample a pixel, so that hues remain distinguishable. */
static void colour_of(int last, int bits, uint8_t rgb[3])
{
    const int level = bits / WR_MAP_SAMPLES;
    const Hue *hue = hue_of(bits);
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(last ? hue->rgb[c] * (last + 2 * level) / (3 * last) : hue->rgb[c]);
}

void wr_heatmap_count(const uint8_t *map, size_t pixels, WrHeatmapCounts *counts)
{
    *counts = (WrHeatmapCounts){ { 0 } };
    for (size_t i = 0; i < pixels; i++) counts->of[map[i]]++;
}

void wr_heatmap_colours(const WrHeatmapCounts *counts, uint8_t rgb[256][3])
{
    const int last = last_level(counts);
    for (int b = 0; b < 256; b++) colour_of(last, b, rgb[b]);
}

static const char *shade_of(const Hue *hue, int level, int last)
{
    return hue == hues || level == last ? "" : level == 0 ? "dark " : "middle ";
}

bool wr_heatmap_line(const WrHeatmapCounts *counts, int i, WrHeatmapLine *out)
{
    const int last = last_level(counts);
    for (const Hue *hue = hues; hue < hues + sizeof hues / sizeof *hues; hue++)
        for (int level = 0; level < LEVELS; level++) {
            *out = (WrHeatmapLine){ .colour = hue->colour,
                                    .shade = shade_of(hue, level, last),
                                    .what = hue->what,
                                    .samples = hue == hues ? 0 : 1 << level };
            for (int b = level * WR_MAP_SAMPLES; b < (level + 1) * WR_MAP_SAMPLES; b++) {
                if (hue_of(b) != hue || counts->of[b] == 0) continue;
                colour_of(last, b, out->rgb);
                out->pixels += counts->of[b];
            }
            if (out->pixels > 0 && i-- == 0) return true;
        }
    return false;
}

void wr_heatmap_colour(const WrHeatmapLine *line, WrText *text)
{
    wr_text_addf(text, "%s%s", line->shade, line->colour);
}

void wr_heatmap_words(const WrHeatmapLine *line, WrText *text)
{
    wr_text_add(text, line->what);
    if (line->samples == 1) wr_text_add(text, ", one sample a pixel");
    if (line->samples > 1)
        wr_text_addf(text, ", up to %d x %d samples", line->samples, line->samples);
}
