/* Height colormap section: a row for each stop, with its height and its colour. Every change is a command line. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "scene/scene.h"

#include <math.h>
#include <stdio.h>

static void add_rgb(WrText *line, const double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        if (c > 0) wr_text_add(line, ",");
        wr_text_add_number(line, rint(rgb[c] * 1e4) / 1e4);
    }
}

/* Run the whole ramp as one line at the end of a drag. */
static void run_ramp(WrApp *app, const WrHeightColormap *own)
{
    WrText line = { 0 };
    wr_text_add(&line, "colouring ramp stops=");
    for (int i = 0; i < own->count; i++) {
        if (i > 0) wr_text_add(&line, ";");
        wr_text_add_number(&line, rint(own->stops[i].height * 1e6) / 1e6);
        wr_text_add(&line, ",");
        add_rgb(&line, own->stops[i].rgb);
    }
    if (own->steep) {
        wr_text_add(&line, " steep=");
        add_rgb(&line, own->steep_rgb);
        wr_text_addf(&line, " slope=%.1f,%.1f", own->slope[0], fmax(own->slope[0], own->slope[1]));
    }
    if (own->hollow) {
        wr_text_add(&line, " cavity=");
        add_rgb(&line, own->hollow_rgb);
        wr_text_addf(&line, " depth=%.4f,%.4f within=%.2f", own->depth[0],
                     fmax(own->depth[0], own->depth[1]), own->within);
    }
    wr_text_addf(&line, " of=%s", wr_height_colormap_names[own->of]);
    wr_scene_run(app, &line);
}

/* Height of a stop, limited by its neighbours. */
static WrEdit height_field(WrHeightColormap *own, int i, double width)
{
    const bool first = i == 0, last = i + 1 == own->count;
    double *height = &own->stops[i].height;
    const double low = first ? fmin(0, *height) - 0.2 : own->stops[i - 1].height;
    const double high = last ? fmax(1, *height) + 0.2 : own->stops[i + 1].height;
    const WrNumber spec = { .low = low,
                            .high = high > low ? high : low + 1e-6,
                            .hard_low = first ? -1e30 : low,
                            .hard_high = last         ? 1e30
                                         : high > low ? high
                                                      : low + 1e-6,
                            .reset = *height,
                            .decimals = 3,
                            .tip = "Starts at this height of the table" };
    return wr_gui_number("height", width, &spec, height);
}

/* The stronger of two edit states: none, dragging, done. */
static WrEdit more(WrEdit a, WrEdit b)
{
    return a == WR_EDIT_DONE || b == WR_EDIT_DONE ? WR_EDIT_DONE : a == WR_EDIT_NONE ? b : a;
}

static WrEdit stop_row(WrHeightColormap *own, int i)
{
    char label[24];
    snprintf(label, sizeof label, wr_words("Stop %d"), i + 1);
    wr_gui_push_id(100 + i);
    wr_gui_label(label);
    const double third = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit a = height_field(own, i, third);
    wr_gui_same_line(8);
    const WrEdit b = wr_gui_colour("colour", third, own->stops[i].rgb);
    wr_gui_pop_id();
    return more(a, b);
}

static WrEdit steep_rows(WrHeightColormap *own)
{
    static const WrNumber spec = {
        .low = 0,
        .high = 90,
        .decimals = 0,
        .unit = "deg",
        .tip = "Slopes at which the colour of steep places begins and is complete"
    };
    bool on = own->steep && own->slope[0] < 90;
    if (wr_gui_check("Colour of steep slopes", &on)) {
        own->steep = true;
        own->slope[0] = on ? 30 : 90, own->slope[1] = on ? 45 : 90;
        return WR_EDIT_DONE;
    }
    if (!on) return WR_EDIT_NONE;
    wr_gui_label("Steep");
    const WrEdit a = wr_gui_colour("steep", 0, own->steep_rgb);
    wr_gui_label("Slopes");
    const double half = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit b = wr_gui_number("slope from", half, &spec, &own->slope[0]);
    wr_gui_same_line(8);
    const WrEdit c = wr_gui_number("slope to", half, &spec, &own->slope[1]);
    return more(a, more(b, c));
}

/* "Off" is a depth that no table reaches, so that the colour survives switching off and on. */
#define NO_DEPTH 1e6

static WrEdit hollow_rows(WrHeightColormap *own)
{
    static const WrNumber depth = { .low = 0,
                                    .high = 0.5,
                                    .hard_low = 0,
                                    .hard_high = NO_DEPTH,
                                    .decimals = 3,
                                    .tip = "Depths below the surrounding mean at which the colour "
                                           "of hollows begins and is complete" };
    static const WrNumber within = { .low = 0.5,
                                     .high = 64,
                                     .hard_low = 0.05,
                                     .hard_high = 512,
                                     .reset = 8,
                                     .decimals = 1,
                                     .unit = "texels",
                                     .tip = "Standard deviation of the Gaussian mean for hollows" };
    bool on = own->hollow && own->depth[0] < NO_DEPTH;
    if (wr_gui_check("Colour of cavities", &on)) {
        own->hollow = true;
        own->depth[0] = on ? 0.01 : NO_DEPTH, own->depth[1] = on ? 0.1 : NO_DEPTH;
        return WR_EDIT_DONE;
    }
    if (!on) return WR_EDIT_NONE;
    wr_gui_label("Cavities");
    const WrEdit a = wr_gui_colour("hollow", 0, own->hollow_rgb);
    wr_gui_label("Depths");
    const double half = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit b = wr_gui_number("depth from", half, &depth, &own->depth[0]);
    wr_gui_same_line(8);
    const WrEdit c = wr_gui_number("depth to", half, &depth, &own->depth[1]);
    wr_gui_label("Within");
    return more(more(a, b), more(c, wr_gui_number("within", 0, &within, &own->within)));
}

static WrEdit ramp_rows(WrApp *app, WrHeightColormap *own)
{
    static const char *const of[WR_COLOURINGS] = { "The form", "The table" };
    WrEdit done = WR_EDIT_NONE;
    int which = (int)own->of;
    const bool terrain = wr_app_scene(app)->shape.kind == WR_SURFACE_terrain;
    if (terrain) wr_gui_label("Heights of");
    if (terrain && wr_gui_choice("colouring of", 0, of, WR_COLOURINGS, &which)) {
        own->of = (WrHeightColormapOf)which;
        done = WR_EDIT_DONE;
    }
    for (int i = 0; i < own->count; i++) done = more(done, stop_row(own, i));
    if (own->count < WR_STOPS_MAX && wr_gui_button("One more stop", false)) {
        own->stops[own->count] = own->stops[own->count - 1];
        own->stops[own->count++].height += 0.1;
        done = WR_EDIT_DONE;
    }
    if (own->count > 1) wr_gui_same_line(8);
    if (own->count > 1 && wr_gui_button("One less", false)) {
        own->count--;
        done = WR_EDIT_DONE;
    }
    done = more(done, steep_rows(own));
    return more(done, hollow_rows(own));
}

void wr_panel_colouring(WrApp *app)
{
    WrHeightColormap own = wr_app_scene(app)->colouring;
    WrText line = { 0 };
    bool on = own.count > 0;
    wr_gui_push_id(3);
    const bool turned = wr_gui_check("Colours by height", &on);
    wr_gui_tip("Colours for water, meadows, rock and snow by height and slope of the terrain or "
               "the table");
    if (turned) {
        wr_text_add(&line, on ? "colouring ramp" : "colouring off");
        wr_scene_run(app, &line);
    } else if (on) {
        const WrEdit edit = ramp_rows(app, &own);
        if (edit == WR_EDIT_LIVE)
            wr_app_live_begin(app)->colouring = own; /* the fields keep the value between
                                                                        frames */
        if (edit == WR_EDIT_DONE) run_ramp(app, &own);
    }
    wr_gui_pop_id();
}
