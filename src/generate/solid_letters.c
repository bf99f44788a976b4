/* Three-dimensional letters: outlines of a font extruded as a plate, with a bevel, in any pose (Blinn
 * 1978, figure 7: the date). */
#include "base/error.h"
#include "base/memory.h"
#include "generate/tile_builder.h"
#include "generate/solid.h"
#include "generate/text_layout.h"
#include "image/font.h"

#define CHORD 0.02 /* maximum distance in texels of straight pieces from the outlines' curves */

static const char *const bevels[] = { WR_Z_BEVELS(WR_WORD) NULL };

const WrParam wr_params_solid_letters[] = {
    { .name = "text",
      .label = "Text",
      .help = "the text, in double quotes if it has a space; \\n begins a line",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .positional = true },
    WR_P_FONT(WR_FONT_SANS_BOLD), /* outlines, not bitmaps */
    WR_P_FONT_FILE,
    WR_S_RADIUS("size", "Size", 96, "of the letters, as fonts count it"),
    WR_S_RADIUS("depth", "Depth", 16, "thickness of the plate"),
    WR_P_TEXELS("bevel", "Bevel", 4, 32, "width of the rounded edge; at most the depth"),
    WR_P_CHOICE("profile", "Profile", WR_Z_BEVEL_ROUND, bevels, "of the edge"),
    WR_P_NUMBER("letters", "Letter spacing", 0, -4096, 4096, 32, "texels", "added between letters"),
    WR_P_NUMBER("lines", "Line spacing", 1, 0, 16, 2, "", "times the font's own"),
    WR_S_POSE,
    WR_S_HEIGHT("of its highest place over its lowest, as it is turned"),
    WR_S_PLACE,
    WR_P_END,
};

/* The outlines relative to the middle of their bounding box. NULL and an error if there are none. */
static WrZLetters *cut(const WrParams *params, WrFontOutline *outline, WrError *err)
{
    int contours = outline->first.count, points = outline->xy.count / 2;
    double low[2] = { 0.0, 0.0 }, high[2] = { 0.0, 0.0 };
    for (int i = 0; i < 2 * points; i++) {
        double x = outline->xy.data[i];
        low[i % 2] = i < 2 || x < low[i % 2] ? x : low[i % 2];
        high[i % 2] = i < 2 || x > high[i % 2] ? x : high[i % 2];
    }
    for (int i = 0; i < 2 * points; i++) outline->xy.data[i] -= 0.5 * (low[i % 2] + high[i % 2]);
    WrZContour *list = wr_alloc((size_t)contours + 1, sizeof *list);
    for (int i = 0; i < contours; i++) {
        int first = outline->first.data[i];
        int end = i + 1 < contours ? outline->first.data[i + 1] : points;
        list[i] = (WrZContour){ outline->xy.data + 2 * (size_t)first, end - first };
    }
    double depth = wr_param_number(params, "depth"), bevel = wr_param_number(params, "bevel");
    WrZLetters *letters = wr_zletters_new(list, contours, depth, bevel < depth ? bevel : depth,
                                          (WrZBevel)wr_param_whole(params, "profile"), err);
    wr_free(list);
    return letters;
}

static void report_missing(const WrGenerateJob *job, const WrFontText *text)
{
    if (text->missing_count > 0)
        wr_generate_note(job, "the font has no glyph for %d of the characters, U+%04X first",
                         (int)text->missing_count, (unsigned)text->missing[0]);
}

static bool outline_of(const WrParams *params, const WrGenerateJob *job, WrFontOutline *outline,
                       WrError *err)
{
    WrFontSetting setting = { .size = wr_param_number(params, "size"),
                              .letter_spacing = wr_param_number(params, "letters"),
                              .line_spacing = wr_param_number(params, "lines"),
                              .align = WR_FONT_CENTRE };
    const WrFontRequest ask = { .text = wr_param_value(params, "text")->text,
                                .face = wr_param_whole(params, "face") };
    const char *file = wr_param_value(params, "file")->text;
    WrFontText text = { 0 };
    char *found = NULL;
    if (!file || !*file) {
        found = wr_font_find(wr_param_whole(params, "font"), setting.size, err);
        if (!found) return false;
        file = found;
    }
    bool good = wr_font_shape(file, &ask, &text, err) &&
                wr_font_outline(&text, &setting, CHORD, outline, err);
    if (good) report_missing(job, &text);
    if (good && outline->first.count == 0)
        good = wr_fail(err, "solid letters: the text has nothing to be cut out");
    wr_font_text_fini(&text);
    wr_free(found);
    return good;
}

/* Lowest and highest corner of the posed box, relative to its origin. */
static void box_range(const WrZSolid *solid, double range[2])
{
    double low[3], high[3];
    wr_zletters_box(solid->letters, low, high);
    range[0] = range[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        double p = solid->pose[6 + k] * low[k], q = solid->pose[6 + k] * high[k];
        range[0] += p < q ? p : q;
        range[1] += p < q ? q : p;
    }
}

static bool draw(const WrParams *params, const WrZLetters *letters, const WrGenerateJob *job,
                 WrRelief *out, WrError *err)
{
    WrSolidPlace *places = NULL;
    int64_t count;
    double rise = 1.0;
    if (!wr_solid_places(params, job, &places, &count, err)) return false;
    WrZSolid *solids = wr_try_alloc((size_t)count, sizeof *solids, "letters", err);
    bool good = solids;
    for (int64_t i = 0; good && i < count; i++) {
        const WrSolidPlace *p = &places[i];
        const double size[3] = { p->scale, p->scale, p->scale };
        double range[2];
        good = wr_zsolid_set(&solids[i], WR_Z_LETTERS, 0.0, letters, size, p->turn, p->at, err);
        if (!good) break;
        box_range(&solids[i], range);
        solids[i].at[2] -= range[0];
        if (i == 0) rise = (range[1] - range[0]) / p->scale;
    }
    WrZScene scene = { .solids = solids, .solid_count = count };
    good = good && wr_solid_draw(params, &scene, rise, job, out, err);
    wr_free(solids);
    wr_free(places);
    return good;
}

bool wr_solid_letters(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_solid_letters, values };
    WrFontOutline outline = { 0 };
    WrZLetters *letters = NULL;
    if (outline_of(&params, job, &outline, err)) letters = cut(&params, &outline, err);
    bool good = letters && draw(&params, letters, job, out, err);
    wr_zletters_free(letters);
    wr_font_outline_fini(&outline);
    return good;
}
