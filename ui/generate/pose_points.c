/* Points of a generator, such as a path for letters. On the canvas, Ctrl+click adds or removes a point, and a drag
   moves it. They are stored in command syntax, "u,v;u,v;...". */
#include "ui/canvas/view.h"
#include "ui/state/app_state.h"
#include "ui/state/input_router.h"
#include "ui/state/keys.h"
#include "ui/state/line.h"
#include "ui/state/session_view.h"
#include "ui/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/views/overlay_marks.h"

#include "base/text.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define NEAR_UNITS 9.0
#define POINTS_MAX 64 /* limit of editable points */

typedef struct Points {
    WrSelectPoint at[POINTS_MAX];
    int count;
} Points;

static int points_param(const WrGenerateState *hand)
{
    for (int i = 0; hand->generator && hand->generator->params[i].name; i++)
        if (hand->generator->params[i].kind == WR_PARAM_POINTS) return i;
    return -1;
}

bool wr_pose_points_taken(const WrGenerateState *hand)
{
    return points_param(hand) >= 0;
}

/* False: malformed, or too many. */
static bool read_points(const char *text, Points *points)
{
    points->count = 0;
    text += strspn(text, " ");
    while (*text) {
        size_t u = strcspn(text, ",;"), v = text[u] == ',' ? strcspn(text + u + 1, ",;") : 0;
        WrSelectPoint *p = &points->at[points->count];
        if (points->count == POINTS_MAX || v == 0 || text[u + 1 + v] == ',') return false;
        if (!wr_number_parse(text, u, &p->u) || !wr_number_parse(text + u + 1, v, &p->v))
            return false;
        points->count++;
        text += u + 1 + v;
        text += *text == ';';
    }
    return true;
}

static void write_points(WrApp *app, int param, const Points *points)
{
    WrGenerateState *hand = app->generate;
    WrText text = { 0 };
    for (int i = 0; i < points->count; i++) {
        if (i > 0) wr_text_add(&text, ";");
        wr_text_add_number(&text, wr_line_round(points->at[i].u, 5));
        wr_text_add(&text, ",");
        wr_text_add_number(&text, wr_line_round(points->at[i].v, 5));
    }
    SDL_utf8strlcpy(hand->value[param].text, wr_text_get(&text), WR_GENERATE_TEXT);
    wr_text_fini(&text);
    hand->preset = -2;
    wr_generate_changed(app);
}

/* Index of the point under the pointer, on any copy of the cell; -1: none. */
static int find(const WrApp *app, const Points *points, const WrPointer *at)
{
    const WrField *field = wr_app_field(app);
    bool around_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool around_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    for (int i = points->count - 1; i >= 0; i--) {
        double du = at->u - points->at[i].u, dv = at->v - points->at[i].v;
        if (around_u) du -= rint(du);
        if (around_v) dv -= rint(dv);
        double pixels = hypot(du * app->view->table_w, dv * app->view->table_h) * app->view->zoom;
        if (pixels < NEAR_UNITS * wr_gui_scale()) return i;
    }
    return -1;
}

/* The first point is moved into the cell; further ones stay where they were clicked, so that a path may cross the
   cell's edges. */
static WrSelectPoint place(const WrApp *app, const Points *points, const WrPointer *at)
{
    WrSelectPoint home = wr_overlay_home(app, at->u, at->v);
    if (points->count > 0) home = (WrSelectPoint){ 0.0, 0.0 };
    return (WrSelectPoint){ at->u + home.u, at->v + home.v };
}

bool wr_pose_points_press(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    hand->point = -1;
    if (param < 0 || !read_points(hand->value[param].text, &points)) return false;
    int i = find(app, &points, at);
    if (at->mods & WR_MOD_CTRL) {
        if (i >= 0) {
            memmove(points.at + i, points.at + i + 1,
                    (size_t)(points.count - i - 1) * sizeof *points.at);
            points.count--;
        } else if (points.count < POINTS_MAX) {
            points.at[points.count] = place(app, &points, at);
            hand->point_first = points.at[points.count];
            hand->point = points.count++;
        }
        write_points(app, param, &points);
    } else if (i >= 0) {
        hand->point = i;
        hand->point_first = points.at[i];
    }
    return points.count > 0 || (at->mods & WR_MOD_CTRL);
}

void wr_pose_points_drag(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    if (param < 0 || !read_points(hand->value[param].text, &points)) return;
    if (hand->point < 0 || hand->point >= points.count) return;
    points.at[hand->point] = (WrSelectPoint){ hand->point_first.u + at->u - app->hand->start.u,
                                              hand->point_first.v + at->v - app->hand->start.v };
    write_points(app, param, &points);
}

bool wr_pose_points_marks(const WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    if (param < 0 || !read_points(hand->value[param].text, &points) || points.count == 0)
        return false;
    wr_overlay_lines(app, points.at, points.count, false, 0x90d0d0d0u);
    for (int i = 0; i < points.count; i++)
        wr_overlay_handle(app, points.at[i].u, points.at[i].v, true, i == hand->point);
    return true;
}
