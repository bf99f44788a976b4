#include "cli/explain_map.h"

#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/session.h"
#include "image/image.h"
#include "render/plan/effect_heatmap.h"

#include <stdio.h>

bool wr_map_check(const WrCli *cli, WrError *err)
{
    return !cli->map || wr_image_can_write(cli->map, WR_PIXEL_U8, 3, true, err);
}

bool wr_map_write(const WrCli *cli, WrSession *session, WrHeatmapCounts *counts, WrError *err)
{
    const size_t pixels = (size_t)cli->width * (size_t)cli->height;
    uint8_t *map = wr_try_alloc(pixels, 1, "map", err), *rgb = NULL;
    bool good = map && wr_session_map(session, cli->width, cli->height, 0, map, err);
    if (good) wr_heatmap_count(map, pixels, counts);
    if (good) rgb = wr_try_alloc(pixels, 3, "map", err);
    uint8_t colours[256][3];
    if (rgb) wr_heatmap_colours(counts, colours);
    for (size_t i = 0; rgb && i < pixels; i++)
        for (int c = 0; c < 3; c++) rgb[3 * i + (size_t)c] = colours[map[i]][c];
    good = rgb &&
           wr_image_write_pixels(cli->map, cli->width, cli->height, 3, WR_PIXEL_U8, true, rgb, err);
    wr_free(map);
    wr_free(rgb);
    return good;
}

/* ---- the legend ---- */

void wr_map_legend(const WrHeatmapCounts *counts, WrText *text)
{
    WrHeatmapLine line;
    wr_text_addf(text, "\n%-7s %9s  %s\n", "colour", "pixels", "in the map");
    for (int i = 0; wr_heatmap_line(counts, i, &line); i++) {
        wr_text_addf(text, "#%02x%02x%02x %9lld  ", line.rgb[0], line.rgb[1], line.rgb[2],
                     (long long)line.pixels);
        wr_heatmap_colour(&line, text);
        wr_text_add(text, ": ");
        wr_heatmap_words(&line, text);
        wr_text_add(text, "\n");
    }
}

void wr_map_legend_json(const WrHeatmapCounts *counts, WrText *text)
{
    WrHeatmapLine line;
    for (int i = 0; wr_heatmap_line(counts, i, &line); i++) {
        wr_text_addf(text, "%s{\"colour\":\"#%02x%02x%02x\",\"what\":\"%s\",\"samples\":%d,",
                     i ? "," : "", line.rgb[0], line.rgb[1], line.rgb[2], line.what, line.samples);
        wr_text_addf(text, "\"pixels\":%lld}", (long long)line.pixels);
    }
}
