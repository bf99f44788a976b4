/* Seam meter: a square on the canvas whose sides stand for the cell's edges; grey where the table is continuous,
   orange where it jumps. */
#include "ui/canvas/overlays/panel_seam.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/job.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/memory.h"
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

/* ---- measurement ---- */

typedef struct Look {
    uint64_t key;   /* of the table, the scheme and the tiling */
    WrField *field; /* owned */
    WrScheme scheme;
    WrSeamOptions options;
    WrCertificate certificate; /* result */
} Look;

struct WrSeamMeter {
    WrJob *job;      /* owned; its work is a Look */
    bool drawn;      /* in this frame */
    uint64_t wanted; /* key of the newest measurement started */
    uint64_t key;    /* key of the certificate; 0: none yet */
    WrCertificate certificate;
};

static void run(void *work, WrPool *pool, const WrProgress *progress)
{
    Look *look = work;
    (void)pool;
    (void)progress;
    look->certificate = wr_certificate_table(look->field, look->scheme, &look->options);
}

static void drop(void *work)
{
    Look *look = work;
    wr_field_free(look->field);
    wr_free(look);
}

static WrSeamMeter *meter_of(WrApp *app)
{
    static const WrJobKind kind = { run, drop };
    if (app->seam_meter) return app->seam_meter;
    app->seam_meter = wr_alloc(1, sizeof *app->seam_meter);
    app->seam_meter->job = wr_job_new(&kind, 1, app->job_event);
    return app->seam_meter;
}

void wr_seam_meter_free(WrApp *app)
{
    if (!app->seam_meter) return;
    wr_job_free(app->seam_meter->job);
    wr_free(app->seam_meter);
    app->seam_meter = NULL;
}

const WrCertificate *wr_seam_meter_certificate(const WrApp *app)
{
    return app->seam_meter && app->seam_meter->key ? &app->seam_meter->certificate : NULL;
}

static uint64_t key_of(WrApp *app)
{
    const uint64_t table = wr_field_key(wr_app_field(app)) * 31 + wr_session_revision(app->session);
    return (table * 8 + (uint64_t)wr_app_scene(app)->scheme) * 4 + (uint64_t)app->settings->tiling;
}

/* Measure with the canvas's tiling; not during strokes, which wrap and make no seams. A large table needs tens of
   milliseconds, so a thread of its own measures it; until then the meter shows the table before. */
static void after(WrApp *app)
{
    WrSeamMeter *meter = app->seam_meter;
    if (!meter || !meter->drawn) return;
    meter->drawn = false;
    const uint64_t key = key_of(app);
    if (key == meter->wanted || wr_session_in_stroke(app->session)) return;
    meter->wanted = key;
    const WrField *field = wr_app_field(app);
    const WrScene *scene = wr_app_scene(app);
    const WrTiling tiling = app->settings->tiling;
    if (scene->analytic.kind != WR_ANALYTIC_OFF) {
        wr_job_cancel(meter->job);
        meter->certificate = wr_certificate_formula(&scene->analytic);
        meter->key = key;
        wr_app_redraw(app);
        return;
    }
    Look *look = wr_alloc(1, sizeof *look);
    look->key = key;
    look->field = wr_field_share(field);
    look->scheme = scene->scheme;
    if (tiling == WR_TILING_HALF_DROP) look->options.shift[0] = wr_field_height(field) / 2;
    if (tiling == WR_TILING_BRICK) look->options.shift[1] = wr_field_width(field) / 2;
    wr_job_start(meter->job, look);
}

static void update(WrApp *app)
{
    WrSeamMeter *meter = app->seam_meter;
    Look *look = meter ? wr_job_take(meter->job) : NULL;
    if (!look) return;
    meter->certificate = look->certificate;
    meter->key = look->key;
    drop(look);
    wr_app_redraw(app);
}

const WrPart wr_part_seam_meter = { .update = update, .after = after };

/* ---- the square ---- */

void wr_panel_seam_meter(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    meter_of(app)->drawn = true;
    const WrCertificate *certificate = wr_seam_meter_certificate(app);
    if (!certificate) return;
    const WrSeam *seam = &certificate->pattern;
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
    wr_certificate_text(certificate, &tip);
    wr_gui_tip(wr_text_get(&tip));
    wr_gui_overlay_end();
    wr_text_fini(&tip);
}
