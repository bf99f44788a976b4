/* The text generator: from parameters to placed outlines. */
#include "base/error.h"
#include "generate/param.h"
#include "generate/text_layout.h"

#include <string.h>

#define AROUNDS(X) X(OFF, "off") X(ALONG_U, "u") X(ALONG_V, "v") X(LATTICE, "lattice")
enum { AROUNDS(WR_WORD_ID) };
#define EDGES(X) X(WRAPPED, "wrap") X(CLIPPED, "clip")
enum { EDGES(WR_WORD_ID) };
static const char *const align_words[] = { WR_FONT_ALIGNS(WR_WORD) NULL };
static const char *const anchor_words[] = { WR_TEXT_ANCHORS(WR_WORD) NULL };
static const char *const direction_words[] = { WR_FONT_DIRECTIONS(WR_WORD) NULL };
static const char *const around_words[] = { AROUNDS(WR_WORD) NULL };
static const char *const missing_words[] = { WR_TEXT_MISSING(WR_WORD) NULL };
static const char *const edge_words[] = { EDGES(WR_WORD) NULL };
static const char *const profile_words[] = { WR_TEXT_PROFILES(WR_WORD) NULL };

static const WrParam params[] = {
    { .name = "text",
      .label = "Text",
      .help = "the letters; \\n begins a new line",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .positional = true },
    WR_P_FONT(WR_FONT_TERMINUS),
    WR_P_FONT_FILE,
    { .name = "axes",
      .label = "Axes",
      .help = "of a variable font, as in wght=650,wdth=80",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    WR_P_MISSING("missing", missing_words),
    WR_P_FALLBACK("fallback", "Other font", "a font file for letters that the font lacks"),
    WR_P_FALLBACK("fallback2", "Second other font", "for what that one lacks too"),
    WR_P_FALLBACK("fallback3", "Third other font", "and for what both lack"),
    WR_P_ABOVE("size", "Size", 64, 0, WR_FONT_SIZE_MAX, 512, "texels",
               "of the font's em; of a bitmap font its dots' height"),
    { .name = "at",
      .label = "Place",
      .help = "where the text's anchor stands",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 0.5, 0.5 },
      .low = -64,
      .high = 64,
      .soft_low = 0,
      .soft_high = 1,
      .shape = "u,v",
      .components = 2 },
    WR_P_CHOICE("align", "Alignment", WR_FONT_CENTRE, align_words,
                "of the lines with one another and to the anchor"),
    WR_P_CHOICE("anchor", "Anchor", WR_TEXT_MIDDLE, anchor_words,
                "what of the text's height stands there"),
    WR_P_NUMBER("letters", "Letter spacing", 0, -16384, 16384, 32, "texels",
                "added between letters"),
    WR_P_NUMBER("lines", "Line spacing", 1, 0, 100, 3, "", "times the font's own"),
    WR_P_NUMBER("rotate", "Turn", 0, -36000, 36000, 180, "degrees",
                "anticlockwise, about the anchor"),
    WR_P_CHOICE("direction", "Direction", WR_FONT_AUTO, direction_words,
                "of a line as a whole; auto: by its first letter"),
    { .name = "language",
      .label = "Language",
      .help = "as in ar, hi, sr: some fonts have other letters for it",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    { .name = "points",
      .label = "Path",
      .help = "the text stands on a smooth curve through these places",
      .unit = "",
      .kind = WR_PARAM_POINTS,
      .low = -64,
      .high = 64 },
    WR_P_CHOICE("around", "Around", OFF, around_words,
                "once round the table, the letters' spacing such that it closes: along u, v or the "
                "lattice direction"),
    { .name = "lattice",
      .label = "Lattice direction",
      .help = "how many tables to the right and up until it closes",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 1, 1 },
      .low = -16,
      .high = 16,
      .soft_low = -4,
      .soft_high = 4,
      .shape = "i,j",
      .components = 2 },
    WR_P_WHOLE("repeats", "Repeats", 0, 0, 4096, 16,
               "around: how many times; 0: as many as fit best"),
    WR_P_CHOICE("edge", "Edges", WRAPPED, edge_words,
                "what passes a periodic edge comes back on the other side, or is cut off"),
    WR_P_CHOICE("profile", "Profile", WR_TEXT_FLAT, profile_words,
                "how it rises from its rim; a ridge has bevel as its run for one height"),
    WR_P_TEXELS("bevel", "Bevel", 4, 64, "how far inside of the rim the height is reached"),
    WR_P_HEIGHT,
    WR_P_END
};

static WrTextRequest wish_of(const WrParams *p)
{
    const WrParamValue *at = wr_param_value(p, "at"), *lattice = wr_param_value(p, "lattice");
    const WrParamValue *path = wr_param_value(p, "points");
    const char *language = wr_param_value(p, "language")->text;
    const char *axes = wr_param_value(p, "axes")->text;
    WrTextRequest wish = {
        .setting = { .size = wr_param_number(p, "size"),
                     .letter_spacing = wr_param_number(p, "letters"),
                     .line_spacing = wr_param_number(p, "lines"),
                     .align = (WrFontAlign)wr_param_whole(p, "align") },
        .at = { at->number[0], at->number[1] },
        .anchor = (WrTextAnchor)wr_param_whole(p, "anchor"),
        .rotate_deg = wr_param_number(p, "rotate"),
        .points = path->points,
        .point_count = path->count,
        .around = wr_param_whole(p, "around") != OFF,
        .repeats = wr_param_whole(p, "repeats"),
        .clip = wr_param_whole(p, "edge") == CLIPPED,
    };
    wish.ask = (WrFontRequest){ .text = wr_param_value(p, "text")->text,
                                .face = wr_param_whole(p, "face"),
                                .direction = (WrFontDirection)wr_param_whole(p, "direction"),
                                .language = language && *language ? language : NULL,
                                .axes = axes && *axes ? axes : NULL };
    wish.lattice[0] = wr_param_whole(p, "around") == ALONG_U ? 1.0 : 0.0;
    wish.lattice[1] = wr_param_whole(p, "around") == ALONG_V ? 1.0 : 0.0;
    for (int k = 0; k < 2 && wr_param_whole(p, "around") == LATTICE; k++)
        wish.lattice[k] = lattice->number[k];
    return wish;
}

static bool make_shaped(const WrTextRequest *wish, const WrFontText *text,
                        const WrTextFinish *finish, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    WrTextShape shape = { 0 };
    if (!wr_text_shape_init(&shape, job->like, wish->clip, err)) return false;
    bool good =
        wr_text_lay(wish, text, job, &shape, err) && wr_text_relief(&shape, finish, job, out, err);
    wr_text_shape_fini(&shape);
    return good;
}

static bool make_text(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    WrParams p = { params, values };
    WrTextRequest wish = wish_of(&p);
    WrTextFinish finish = { (WrTextProfile)wr_param_whole(&p, "profile"),
                            wr_param_number(&p, "bevel"), wr_param_number(&p, "height") };
    WrFontText text = { 0 };
    if (!wr_text_shape(&p, &wish.ask, wish.setting.size, job, &text, err)) return false;
    bool good = make_shaped(&wish, &text, &finish, job, out, err);
    wr_font_text_fini(&text);
    return good;
}

const WrGenerator wr_text_rows[] = {
    { .family = "text",
      .label = "Text",
      .help = "letters of any font and script, in relief",
      .blend = "add",
      .params = params,
      .make = make_text },
    { .family = NULL },
};
