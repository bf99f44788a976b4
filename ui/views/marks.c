/* Outline of the selection on every copy of the cell, as an animated dashed line. */
#include "ui/views/marks.h"
#include "ui/canvas/marching_ants.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/state/roster.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/retained_frame.h"

#include "base/array.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>

#define STEP_SECONDS 0.2 /* period of the animation */
#define IDLE_SECONDS 20  /* the animation stops after this time without user input */
#define DASH 4           /* length of a dash, pixels at scale 1 */

void wr_marks_update(WrApp *app)
{
    WrMarks *marks = app->marks;
    const WrField *selection = wr_app_document(app)->selection;
    uint64_t key = selection ? wr_field_key(selection) : 0;
    if (marks->trying || key == marks->asked_key) return;
    marks->asked_key = key;
    if (selection) wr_outliner_ask(marks->outliner, wr_app_document(app), &(WrOutlineRequest){ 0 });
    else wr_outliner_clear(marks->outliner);
    wr_app_redraw(app);
}

void wr_marks_try(WrApp *app, const WrOutlineRequest *ask)
{
    WrMarks *marks = app->marks;
    marks->trying = ask != NULL;
    marks->asked_key = 0;
    if (ask) wr_outliner_ask(marks->outliner, wr_app_document(app), ask);
    else wr_outliner_clear(marks->outliner);
    wr_app_redraw(app);
}

/* Draw the pixels, alternately white and black along the line. */
static void draw(const WrApp *app, const WrMarchingAnts *ants, int phase)
{
    static const uint32_t colours[2] = { 0xfffafafau, 0xff101010u };
    WrRetainedFrame *kept = wr_gui_kept(app->gui);
    SDL_Point chunk[512];
    double dash = DASH * wr_gui_scale();
    for (int pass = 0; pass < 2; pass++) {
        int count = 0;
        for (int i = 0; i < ants->pixels.count; i++) {
            const WrAnt *ant = &ants->pixels.data[i];
            double place = (double)ant->along / dash - phase / 4.0;
            if (((int)floor(place) & 1) != pass) continue;
            chunk[count++] = ant->at;
            if (count < 512) continue;
            wr_retained_frame_points(kept, chunk, count, colours[pass]);
            count = 0;
        }
        wr_retained_frame_points(kept, chunk, count, colours[pass]);
    }
}

void wr_marks_draw(WrApp *app)
{
    WrMarks *marks = app->marks;
    uint64_t serial;
    const WrField *field = wr_app_field(app);
    bool wraps_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool wraps_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    const WrOutline *outline = wr_outliner_get(marks->outliner, &serial);
    int phase = (int)fmod(marks->stepped_at / STEP_SECONDS, 8.0);
    if (outline) {
        if (serial != marks->traced || !wr_view_same(app->view, &marks->traced_view))
            wr_marching_ants_trace(&marks->ants, outline, app->view, wraps_u, wraps_v);
        marks->traced = serial;
        marks->traced_view = *app->view;
        draw(app, &marks->ants, phase);
    } else {
        marks->ants.pixels.count = 0;
    }
    if (!app->select->active) return;
    marks->shape.pixels.count = 0;
    marks->shape.cut = false;
    wr_marching_ants_add(&marks->shape, app->select->points.data, app->select->points.count, 0, 0,
                         app->view, wraps_u, wraps_v);
    draw(app, &marks->shape, phase);
}

double wr_marks_next_time(const WrApp *app)
{
    const WrMarks *marks = app->marks;
    bool there = marks->ants.pixels.count > 0;
    bool focus = (SDL_GetWindowFlags(app->window) & SDL_WINDOW_INPUT_FOCUS) != 0;
    if (!there || !focus || !app->visible || !app->settings->ants || app->layout->canvas.w <= 0)
        return 0.0;
    if (wr_clock_seconds() - app->input_at > IDLE_SECONDS) return 0.0;
    return marks->stepped_at + STEP_SECONDS;
}

void wr_marks_free(WrApp *app)
{
    wr_outliner_free(app->marks->outliner);
    wr_marching_ants_free(&app->marks->ants);
    wr_marching_ants_free(&app->marks->shape);
    wr_array_free(&app->select->points);
}

static bool works(WrApp *app)
{
    return wr_outliner_busy(app->marks->outliner, NULL, NULL);
}

/* Advance the animation. */
static void update(WrApp *app)
{
    double now = wr_clock_seconds(), due = wr_marks_next_time(app);
    if (due != 0.0 && now >= due) {
        app->marks->stepped_at = now;
        if (app->redraw == 0) app->redraw = 1;
    }
    wr_marks_update(app);
}

const WrPart wr_part_marks = { .update = update, .next_time = wr_marks_next_time, .works = works };
