#include "cli/explain_map.h"

#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/session.h"
#include "image/image.h"
#include "render/frame.h"

#include <stdio.h>

/* By hue: what ran. By lightness: how many samples, from a third to all of it. */
typedef struct Hue {
    int mask, bits;
    const char *what;
    uint8_t rgb[3];
} Hue;

static const Hue hues[] = {
    { WR_MAP_RENDERED, 0, "not rendered: left as it was", { 0, 0, 0 } },
    { WR_MAP_COVERED, 0, "nothing of the object", { 96, 96, 128 } },
    { WR_MAP_LOOKED, 0, "light alone, no bump", { 224, 224, 224 } },
    { WR_MAP_WIDE, WR_MAP_WIDE, "bump from filtered slopes", { 255, 128, 0 } },
    { 0, 0, "bump", { 0, 200, 255 } },
};

#define LEVELS (256 / WR_MAP_SAMPLES)

static const Hue *hue_of(int bits)
{
    const Hue *hue = hues;
    while ((bits & hue->mask) != hue->bits) hue++;
    return hue;
}

static int last_level(const WrMapCounts *counts)
{
    int last = 0;
    for (int b = 0; b < 256; b++)
        if (counts->of[b] > 0 && b / WR_MAP_SAMPLES > last) last = b / WR_MAP_SAMPLES;
    return last;
}

/* The most samples that are there have the whole colour. */
static void colour_of(const WrMapCounts *counts, int bits, uint8_t rgb[3])
{
    const int last = last_level(counts), level = bits / WR_MAP_SAMPLES;
    const Hue *hue = hue_of(bits);
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(last ? hue->rgb[c] * (last + 2 * level) / (3 * last) : hue->rgb[c]);
}

bool wr_map_check(const WrCli *cli, WrError *err)
{
    return !cli->map || wr_image_can_write(cli->map, WR_PIXEL_U8, 3, true, err);
}

bool wr_map_write(const WrCli *cli, WrSession *session, WrMapCounts *counts, WrError *err)
{
    const size_t pixels = (size_t)cli->width * (size_t)cli->height;
    uint8_t *map = wr_try_alloc(pixels, 1, "map", err), *rgb = NULL;
    bool good = map && wr_session_map(session, cli->width, cli->height, 0, map, err);
    *counts = (WrMapCounts){ { 0 } };
    for (size_t i = 0; good && i < pixels; i++) counts->of[map[i]]++;
    if (good) rgb = wr_try_alloc(pixels, 3, "map", err);
    uint8_t colours[256][3];
    for (int b = 0; b < 256; b++) colour_of(counts, b, colours[b]);
    for (size_t i = 0; rgb && i < pixels; i++)
        for (int c = 0; c < 3; c++) rgb[3 * i + (size_t)c] = colours[map[i]][c];
    good = rgb &&
           wr_image_write_pixels(cli->map, cli->width, cli->height, 3, WR_PIXEL_U8, true, rgb, err);
    wr_free(map);
    wr_free(rgb);
    return good;
}

/* ---- the legend ---- */

typedef struct Line {
    uint8_t rgb[3];
    const char *what;
    int samples; /* a side, at most; 0: not rendered */
    int64_t pixels;
} Line;

/* Line i of those that are there, of several bits that have one colour. */
static bool line_at(const WrMapCounts *counts, int i, Line *out)
{
    for (const Hue *hue = hues; hue < hues + sizeof hues / sizeof *hues; hue++)
        for (int level = 0; level < LEVELS; level++) {
            *out = (Line){ .what = hue->what, .samples = hue == hues ? 0 : 1 << level };
            for (int b = level * WR_MAP_SAMPLES; b < (level + 1) * WR_MAP_SAMPLES; b++) {
                if (hue_of(b) != hue || counts->of[b] == 0) continue;
                colour_of(counts, b, out->rgb);
                out->pixels += counts->of[b];
            }
            if (out->pixels > 0 && i-- == 0) return true;
        }
    return false;
}

static void add_what(WrText *text, const Line *line)
{
    wr_text_add(text, line->what);
    if (line->samples == 1) wr_text_add(text, ", one sample a pixel");
    if (line->samples > 1)
        wr_text_addf(text, ", up to %d x %d samples", line->samples, line->samples);
}

void wr_map_legend(const WrMapCounts *counts, WrText *text)
{
    Line line;
    wr_text_addf(text, "\n%-7s %9s  %s\n", "colour", "pixels", "in the map");
    for (int i = 0; line_at(counts, i, &line); i++) {
        wr_text_addf(text, "#%02x%02x%02x %9lld  ", line.rgb[0], line.rgb[1], line.rgb[2],
                     (long long)line.pixels);
        add_what(text, &line);
        wr_text_add(text, "\n");
    }
}

void wr_map_legend_json(const WrMapCounts *counts, WrText *text)
{
    Line line;
    for (int i = 0; line_at(counts, i, &line); i++) {
        wr_text_addf(text, "%s{\"colour\":\"#%02x%02x%02x\",\"what\":\"%s\",\"samples\":%d,",
                     i ? "," : "", line.rgb[0], line.rgb[1], line.rgb[2], line.what, line.samples);
        wr_text_addf(text, "\"pixels\":%lld}", (long long)line.pixels);
    }
}
