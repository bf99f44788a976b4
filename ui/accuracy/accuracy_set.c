/* Changes of dials: of A, the scene, by commands; of B, which is only in the window. */
#include "ui/accuracy/accuracy.h"
#include "field/scheme_list.h"
#include "ui/state/busy.h"
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/state/scene_line.h"
#include "ui/state/session_view.h"
#include "ui/preview/accuracy_choice.h"

#include "accuracy/ladder.h"
#include "base/text.h"
#include "field/scheme.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <string.h>

/* Initial dials of B: almost no error. */
static void give_b(WrAccuracy *a, const WrScene *scene)
{
    if (a->b_given) return;
    a->b_given = true;
    for (int d = 0; d < WR_DIAL_COUNT; d++) a->b[d] = wr_dials[d].get(scene);
    a->b[WR_DIAL_SCHEME] = WR_SCHEME_BSPLINE_FIT;
    if (a->b[WR_DIAL_NORMAL] != WR_BUMP_INVARIANT) a->b[WR_DIAL_NORMAL] = WR_BUMP_EXACT;
    a->b[WR_DIAL_AA] = WR_AA_SUPERSAMPLE;
    a->b[WR_DIAL_SAMPLES] = 8;
}

double wr_accuracy_dial(const WrApp *app, int side, int dial)
{
    if (side == 1) give_b(app->accuracy, wr_app_scene(app));
    return side == 1 ? app->accuracy->b[dial] : wr_dials[dial].get(wr_app_scene(app));
}

WrScene *wr_accuracy_scene(const WrApp *app, int side)
{
    WrScene *scene = wr_scene_clone(wr_app_scene(app));
    for (int d = 0; d < WR_DIAL_COUNT; d++) wr_dials[d].set(scene, wr_accuracy_dial(app, side, d));
    scene->tolerance.kind = WR_TOLERANCE_NONE;
    return scene;
}

static void add_dial(WrText *line, int dial, double value)
{
    const WrDial *d = &wr_dials[dial];
    if (line->length == 0) wr_text_add(line, d->command);
    wr_text_addf(line, " %s=", d->name);
    if (d->choices > 0) wr_text_add(line, d->choice((int)value));
    else wr_text_add_number(line, value);
}

/* Set the scene's dials with as few commands as possible. */
static void set_all(WrApp *app, const double value[WR_DIAL_COUNT])
{
    static const char *const verbs[] = { "bump", "material", "dials" };
    wr_app_settle(app);
    wr_app_live_end(app);
    if (wr_app_scene(app)->tolerance.kind != WR_TOLERANCE_NONE &&
        !wr_app_run_line(app, "tolerance off"))
        return;
    for (int v = 0; v < (int)(sizeof verbs / sizeof *verbs); v++) {
        WrText line = { 0 };
        for (int d = 0; d < WR_DIAL_COUNT; d++)
            if (strcmp(wr_dials[d].command, verbs[v]) == 0 &&
                wr_dials[d].get(wr_app_scene(app)) != value[d])
                add_dial(&line, d, value[d]);
        if (line.length > 0) wr_app_run_line(app, wr_text_get(&line));
        wr_text_fini(&line);
    }
}

static void set_b(WrApp *app, const double value[WR_DIAL_COUNT])
{
    WrAccuracy *a = app->accuracy;
    memcpy(a->b, value, sizeof a->b);
    a->b_given = true;
    a->b_serial++;
    wr_app_redraw(app);
}

void wr_accuracy_set_dial(WrApp *app, int side, int dial, double value)
{
    if (side == 1) {
        wr_accuracy_dial(app, side, dial);
        app->accuracy->b[dial] = value;
        app->accuracy->b_serial++;
        return;
    }
    WrText line = { 0 };
    add_dial(&line, dial, value);
    wr_scene_run(app, &line);
}

static void read_all(const WrScene *scene, double value[WR_DIAL_COUNT])
{
    for (int d = 0; d < WR_DIAL_COUNT; d++) value[d] = wr_dials[d].get(scene);
}

void wr_accuracy_take_rung(WrApp *app, int side, int rung)
{
    const WrAccuracy *a = app->accuracy;
    double value[WR_DIAL_COUNT];
    if (!a->plot || rung < 0 || rung >= a->plot->ladder.count) return;
    WrScene *scene = wr_setting_apply(&a->plot->ladder.rungs[rung].setting, a->plot->scene);
    read_all(scene, value);
    wr_scene_free(scene);
    if (side == 1) set_b(app, value);
    else set_all(app, value);
}

void wr_accuracy_b_from_a(WrApp *app)
{
    double value[WR_DIAL_COUNT];
    read_all(wr_app_scene(app), value);
    set_b(app, value);
}

void wr_accuracy_swap(WrApp *app)
{
    double a[WR_DIAL_COUNT], b[WR_DIAL_COUNT];
    for (int d = 0; d < WR_DIAL_COUNT; d++) b[d] = wr_accuracy_dial(app, 1, d);
    read_all(wr_app_scene(app), a);
    set_b(app, a);
    set_all(app, b);
}

void wr_accuracy_keep(WrApp *app)
{
    const WrChosen *chosen = &app->accuracy->full_times.chosen;
    if (chosen->any) set_all(app, chosen->finest);
}

void wr_accuracy_words(const WrApp *app, int side, WrText *text)
{
    const WrTolerance *tolerance = &wr_app_scene(app)->tolerance;
    if (side == 0 && tolerance->kind != WR_TOLERANCE_NONE) {
        wr_text_addf(text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
        wr_text_add_number(text, tolerance->value);
        return;
    }
    WrScene *scene = wr_accuracy_scene(app, side);
    wr_text_addf(text, "%s %s", wr_bumps[scene->bump].name, wr_schemes[scene->scheme].name);
    const WrDials *dials = &scene->dials;
    const bool grid = dials->aa == WR_AA_SUPERSAMPLE || dials->aa == WR_AA_ADAPTIVE;
    if (dials->aa != WR_AA_SUPERSAMPLE)
        wr_text_addf(text, " %s", wr_dials[WR_DIAL_AA].choice((int)dials->aa));
    if (grid) wr_text_addf(text, " %d\xc3\x97%d", dials->samples, dials->samples);
    for (int d = WR_DIAL_SAMPLES + 1; d < WR_DIAL_COUNT;
         d++) { /* dials that differ between A and B */
        const WrDial *dial = &wr_dials[d];
        const double value = dial->get(scene);
        if ((dial->matters && !dial->matters(scene)) || value == wr_accuracy_dial(app, 1 - side, d))
            continue;
        wr_text_addf(text, " %s=", dial->name);
        if (dial->choices > 0) wr_text_add(text, dial->choice((int)value));
        else wr_text_add_number(text, value);
    }
    wr_scene_free(scene);
}
