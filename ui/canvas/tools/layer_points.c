/* Points of a generator layer whose line is a shape or a ramp: handles on the canvas, dragged by any tool. */
#include "ui/canvas/tools/layer_points.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/line.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/tools/tool_shape.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/gui.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/command_table.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define POINTS_MAX 256
#define NEAR_UNITS 9.0

/* A position in the line: number pair `row` of an argument. */
typedef struct Point {
    int arg, row;
    double u, v;
} Point;

/* The call of the active layer's line, if its points can be dragged; the caller frees it. */
static WrCall *call_of(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    WrCall *call = NULL;
    if (!layer->line || layer->on_mask || layer->locked || !layer->visible) return NULL;
    if (!wr_call_parse(layer->line, false, &call, NULL)) return NULL;
    if (call->command->has_handles) return call;
    wr_call_free(call);
    return NULL;
}

/* An ellipse's half sizes: its handle is the corner of the box around it. */
static bool is_radii(const WrArgSpec *spec)
{
    return strcmp(spec->name, "radii") == 0;
}

static int list(const WrCall *call, Point points[POINTS_MAX])
{
    int count = 0;
    for (int i = 0; i < call->count; i++) {
        const WrArgSpec *spec = &call->specs[i];
        const WrArg *arg = &call->args[i];
        const bool pairs = spec->shape && strncmp(spec->shape, "u,v", 3) == 0;
        if (!arg->given || !arg->numbers || !(pairs || is_radii(spec))) continue;
        const double *middle = is_radii(spec) ? wr_call_arg(call, "at")->numbers : NULL;
        for (int row = 0; row < arg->rows && count < POINTS_MAX; row++)
            points[count++] = (Point){ i, row, arg->numbers[2 * row] + (middle ? middle[0] : 0.0),
                                       arg->numbers[2 * row + 1] + (middle ? middle[1] : 0.0) };
    }
    return count;
}

/* The point under the pointer, on any copy of the cell; -1: none. */
static int find(const WrApp *app, const WrPointer *at, const Point *points, int count)
{
    const WrField *field = wr_app_field(app);
    for (int i = count - 1; i >= 0; i--) {
        double du = at->u - points[i].u, dv = at->v - points[i].v;
        if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) du -= rint(du);
        if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) dv -= rint(dv);
        const double pixels =
            hypot(du * app->view->table_w, dv * app->view->table_h) * app->view->zoom;
        if (pixels < NEAR_UNITS * wr_gui_scale()) return i;
    }
    return -1;
}

/* The argument with its pair `point` at u, v, as a change of the layer's line. */
static void change(WrApp *app, const WrCall *call, const Point *point, WrEdit edit)
{
    const WrArgSpec *spec = &call->specs[point->arg];
    const WrArg *arg = &call->args[point->arg];
    const double *middle = is_radii(spec) ? wr_call_arg(call, "at")->numbers : NULL;
    const double moved[2] = { middle ? fabs(point->u - middle[0]) : point->u,
                              middle ? fabs(point->v - middle[1]) : point->v };
    WrText words = { 0 }, line = { 0 };
    wr_text_addf(&words, "%s=", spec->name);
    for (int row = 0; row < arg->rows; row++) {
        const double *pair = row == point->row ? moved : arg->numbers + 2 * row;
        if (row) wr_text_add(&words, ";");
        wr_text_add_number(&words, wr_line_round(pair[0], 6));
        wr_text_add(&words, ",");
        wr_text_add_number(&words, wr_line_round(pair[1], 6));
    }
    wr_text_addf(&line, "layer set %d change=", wr_app_document(app)->active + 1);
    wr_text_add_word(&line, wr_text_get(&words));
    wr_app_try_command(app, edit, wr_text_get(&line));
    wr_text_fini(&words);
    wr_text_fini(&line);
}

bool wr_layer_points_press(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    Point points[POINTS_MAX];
    WrCall *call = call_of(app);
    const int found = call ? find(app, at, points, list(call, points)) : -1;
    wr_call_free(call);
    if (found < 0) return false;
    draw->point = (WrDrawPoint){ found + 1, points[found].u, points[found].v,
                                 points[found].u - at->u, points[found].v - at->v };
    return true;
}

/* Move the held point with the pointer. */
static void follow(WrApp *app, const WrPointer *at, WrEdit edit)
{
    WrDrawPoint *held = &app->draw->point;
    Point points[POINTS_MAX];
    WrCall *call = call_of(app);
    const int count = call ? list(call, points) : 0;
    if (held->number > 0 && held->number <= count) {
        Point point = points[held->number - 1];
        const bool moves = at->u + held->off_u != held->u || at->v + held->off_v != held->v;
        point.u = held->u = at->u + held->off_u;
        point.v = held->v = at->v + held->off_v;
        const bool changed =
            point.u != points[held->number - 1].u || point.v != points[held->number - 1].v;
        if (edit == WR_EDIT_DONE ? changed : moves) change(app, call, &point, edit);
    }
    wr_call_free(call);
    wr_app_redraw(app);
}

void wr_layer_points_drag(WrApp *app, const WrPointer *at)
{
    follow(app, at, WR_EDIT_LIVE);
}

void wr_layer_points_release(WrApp *app, const WrPointer *at)
{
    follow(app, at, WR_EDIT_DONE);
    app->draw->point.number = 0;
}

void wr_layer_points_cancel(WrApp *app)
{
    app->draw->point.number = 0;
    wr_app_try_end(app);
}

void wr_layer_points_marks(const WrApp *app)
{
    const WrDrawPoint *held = &app->draw->point;
    Point points[POINTS_MAX];
    WrCall *call = call_of(app);
    const int count = call ? list(call, points) : 0;
    for (int i = 0; i < count; i++) {
        const bool hot = held->number == i + 1;
        wr_overlay_handle(app, hot ? held->u : points[i].u, hot ? held->v : points[i].v,
                          !is_radii(&call->specs[points[i].arg]), hot);
    }
    wr_call_free(call);
}
