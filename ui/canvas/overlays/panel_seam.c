/* Seam meter: a square on the canvas whose sides stand for the cell's edges; grey where the table is continuous,
   orange where it jumps. */
#include "ui/canvas/overlays/panel_seam.h"
#include "ui/toolkit/words.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/text.h"
#include "command/session.h"
#include "field/field.h"
#include "field/seam_check.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>

#define QUIET WR_COLOUR_LEVEL
#define CREASED WR_COLOUR_WARN

static WrColour colour_of(const WrSeamEdge *edge)
{
    return edge->ends          ? WR_COLOUR_GRAB
           : edge->order == -1 ? WR_COLOUR_RAISE
           : edge->order == 0  ? CREASED
                               : QUIET;
}

static const char *word_of(const WrSeamEdge *edge)
{
    return edge->ends          ? wr_words("the table ends there")
           : edge->order == -1 ? wr_words("the height jumps")
           : edge->order == 0  ? wr_words("the slope breaks")
                               : wr_words("smooth");
}

static void add_numbers(WrText *tip, const WrSeamEdge *edge)
{
    if (!edge->measured) return;
    char numbers[200];
    wr_words_print(numbers, sizeof numbers,
                   wr_words("\n   height %.3g across the edge, %.3g across the worst line inside"
                            "\n   slope %.3g a texel, inside %.3g"),
                   edge->across[WR_SEAM_STEP], edge->inside[WR_SEAM_STEP],
                   edge->across[WR_SEAM_SLOPE], edge->inside[WR_SEAM_SLOPE]);
    wr_text_add(tip, numbers);
}

/* Measure with the canvas's tiling; not during strokes, which wrap and make no seams. The first picture of a change does not
   wait for it: a large table needs some milliseconds. */
static void measure(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    const WrScene *scene = wr_app_scene(app);
    const WrTiling tiling = app->settings->tiling;
    const WrSeamOptions lay = { .shift = {
                                    tiling == WR_TILING_HALF_DROP ? wr_field_height(field) / 2 : 0,
                                    tiling == WR_TILING_BRICK ? wr_field_width(field) / 2 : 0 } };
    const uint64_t key = ((wr_field_key(field) * 31 + wr_session_revision(app->session)) * 8 +
                          (uint64_t)scene->scheme) *
                             4 +
                         (uint64_t)tiling;
    if (key == app->seam_key || wr_session_in_stroke(app->session)) return;
    const bool fresh = app->seam_key != 0 && key != app->seam_wanted;
    app->seam_wanted = key;
    if (fresh) {
        wr_app_redraw(app);
        return;
    }
    *app->certificate = scene->analytic.kind != WR_ANALYTIC_OFF
                            ? wr_certificate_formula(&scene->analytic)
                            : wr_certificate_table(field, scene->scheme, &lay);
    *app->seam = app->certificate->pattern;
    app->seam_key = key;
}

void wr_panel_seam_meter(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    measure(app);
    const WrSeam *seam = app->seam;
    WrColour u = colour_of(&seam->u), v = colour_of(&seam->v), sides[4] = { u, u, v, v };
    WrText tip = { 0 };
    wr_gui_overlay_begin("##seam", room->x + room->w - wr_gui_px(12), room->y + wr_gui_px(12), 1,
                         0);
    wr_gui_edge_colours_square("seam", 26, sides);
    wr_text_addf(&tip, wr_words("Left and right edge: %s"), word_of(&seam->u));
    add_numbers(&tip, &seam->u);
    wr_text_addf(&tip, wr_words("\nTop and bottom edge: %s"), word_of(&seam->v));
    add_numbers(&tip, &seam->v);
    wr_text_addf(&tip, wr_words("\nBy the scheme at hand (%s): "),
                 wr_app_scene(app)->analytic.kind != WR_ANALYTIC_OFF
                     ? wr_words("a formula")
                     : wr_words(wr_schemes[wr_app_scene(app)->scheme].title));
    wr_certificate_text(app->certificate, &tip);
    wr_gui_tip(wr_text_get(&tip));
    wr_gui_overlay_end();
    wr_text_fini(&tip);
}
