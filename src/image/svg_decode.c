/* Rasterizing of SVG files in the present process. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/librsvg.h"
#include "image/module_path.h"
#include "image/svg.h"

#include <math.h>
#include <string.h>

static const WrLibrsvgTable *library(WrError *err)
{
    static WrModule module = { .file = "wrinkle_librsvg.so",
                               .serves = "SVG files",
                               .package = WR_LIBRSVG_PACKAGE,
                               .symbol = WR_LIBRSVG_SYMBOL,
                               .version = WR_LIBRSVG_VERSION,
                               .loading = { .work = wr_module_load, .ctx = &module } };
    return wr_module_table(&module, err);
}

bool wr_svg_load(WrError *err)
{
    return library(err) != NULL;
}

/* True if a tag of that name begins somewhere; not in packed files. */
static bool has_tag(const char *bytes, size_t length, const char *tag)
{
    const size_t count = strlen(tag);
    for (size_t i = 0; i + count < length; i++)
        if (bytes[i] == tag[0] && memcmp(bytes + i, tag, count) == 0) return true;
    return false;
}

/* The coverage of a premultiplied pixel: its opacity, or the part of it that is dark or light by its code's luma (Rec. 709). */
static uint8_t cover_of(uint32_t pixel, int take)
{
    const double alpha = pixel >> 24;
    const double luma =
        0.2126 * (pixel >> 16 & 255) + 0.7152 * (pixel >> 8 & 255) + 0.0722 * (pixel & 255);
    const double part = take == WR_SVG_ALL ? alpha : take == WR_SVG_DARK ? alpha - luma : luma;
    return (uint8_t)(part > 0.0 ? part + 0.5 : 0.0);
}

static bool draw(const WrLibrsvgTable *table, const WrLibrsvgDrawing *drawing,
                 const WrSvgRequest *ask, WrSvgHead *head, WrText *block, bool *memory,
                 WrError *err)
{
    char reason[WR_LIBRSVG_REASON] = "";
    double box[4];
    if (!table->box(drawing, ask->page == 1, box, reason)) return wr_fail(err, "%s", reason);
    const double longest = box[2] > box[3] ? box[2] : box[3], scale = ask->side / longest;
    if (!(box[2] > 0.0 && box[3] > 0.0)) return wr_fail(err, "draws nothing");
    if (!isfinite(scale) || !(scale > 0.0) || !isfinite(box[0]) || !isfinite(box[1]))
        return wr_fail(err, "its size cannot be drawn");
    for (int k = 0; k < 2; k++) head->box[k] = scale * box[2 + k];
    head->width = (int32_t)ceil(head->box[0] - 1e-6) + 2;
    head->height = (int32_t)ceil(head->box[1] - 1e-6) + 2;
    const size_t count = (size_t)head->width * (size_t)head->height;
    uint32_t *pixels = wr_try_alloc(count, sizeof *pixels, "a drawing", err);
    if (!pixels) {
        *memory = true;
        return false;
    }
    bool good = table->draw(drawing, box, scale, head->width, head->height, pixels, reason) ||
                wr_fail(err, "%s", reason);
    if (good) wr_text_add_n(block, (const char *)head, sizeof *head);
    uint8_t *row = wr_alloc((size_t)head->width, 1);
    for (size_t j = 0; good && j < (size_t)head->height; j++) {
        for (size_t i = 0; i < (size_t)head->width; i++)
            row[i] = cover_of(pixels[j * (size_t)head->width + i], ask->take);
        wr_text_add_n(block, (const char *)row, (size_t)head->width);
    }
    wr_free(row);
    wr_free(pixels);
    return good;
}

bool wr_svg_make(const void *bytes, size_t length, const WrSvgRequest *ask, WrText *block,
                 bool *memory, WrError *err)
{
    char reason[WR_LIBRSVG_REASON] = "";
    const WrLibrsvgTable *table = library(err);
    if (!table) return false;
    WrLibrsvgDrawing *drawing = table->open(bytes, length, reason);
    if (!drawing) return wr_fail(err, "is not an SVG file that can be drawn (%s)", reason);
    WrSvgHead head = { .text = has_tag(bytes, length, "<text") };
    const bool good = draw(table, drawing, ask, &head, block, memory, err);
    table->close(drawing);
    return good;
}
