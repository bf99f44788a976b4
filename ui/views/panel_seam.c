/* The seam meter: a square on the canvas, one side an edge of the cell; quiet where the table goes on
   smoothly, orange where it jumps. */
#include "ui/views/panel_seam.h"
#include "ui/gui/words.h"
#include "ui/desk/desk.h"
#include "ui/desk/layout.h"
#include "ui/desk/session_view.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"

#include "base/text.h"
#include "command/session.h"
#include "field/certificate.h"
#include "field/field.h"
#include "field/seam.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>

#define QUIET WR_COLOUR_LEVEL
#define CREASED WR_COLOUR_WARN

static WrColour colour_of(const WrSeamEdge *edge)
{
    return !edge->wraps    ? WR_COLOUR_GRAB
           : edge->jumps   ? WR_COLOUR_RAISE
           : edge->creases ? CREASED
                           : QUIET;
}

static const char *word_of(const WrSeamEdge *edge)
{
    return !edge->wraps    ? wr_words("the table ends there")
           : edge->jumps   ? wr_words("the height jumps")
           : edge->creases ? wr_words("the slope breaks")
                           : wr_words("smooth");
}

static void add_numbers(WrText *tip, const WrSeamEdge *edge)
{
    if (!edge->wraps) return;
    wr_text_addf(tip,
                 wr_words("\n   step %.3g, at most %.3g; inside up to %.3g\n"
                          "   change of slope %.3g a texel; inside up to %.3g"),
                 edge->jump, edge->jump_most, edge->jump_inside, edge->crease, edge->crease_inside);
}

/* Measured when the table rests: a stroke wraps and makes no seams. */
static void measure(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    const WrScene *scene = wr_app_scene(app);
    const uint64_t key = (wr_field_key(field) * 31 + wr_session_revision(app->session)) * 8 +
                         (uint64_t)scene->scheme;
    if (key == app->seam_key || wr_session_in_stroke(app->session)) return;
    *app->seam = wr_seam_measure(field, 256);
    *app->certificate = scene->analytic.kind != WR_ANALYTIC_OFF
                            ? wr_certificate_formula(&scene->analytic)
                            : wr_certificate_table(field, scene->scheme);
    app->seam_key = key;
}

void wr_panel_seam(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    measure(app);
    const WrSeam *seam = app->seam;
    WrColour u = colour_of(&seam->u), v = colour_of(&seam->v), sides[4] = { u, u, v, v };
    WrText tip = { 0 };
    wr_gui_overlay_begin("##seam", room->x + room->w - wr_gui_px(12), room->y + wr_gui_px(12), 1,
                         0);
    wr_gui_square("seam", 26, sides);
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
