/* Histogram of heights in the dialog of the operation `levels`, with draggable low and high limits. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panel_adjust.h"

#include "document/document.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define ROOM_UNITS 96
#define SAMPLES 1048576.0 /* approximate number of counted texels */
#define STEPS 64          /* segments of the drawn curve */

static int index_of(const WrOpInfo *op, const char *name)
{
    int i = 0;
    while (strcmp(op->params[i].name, name) != 0) i++;
    return i;
}

/* Table that the dialog changes: the active layer's heights or its mask; for a filter, the composite below it. */
static const WrField *table_of(const WrApp *app)
{
    if (app->adjust->below) return app->adjust->below;
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    return layer->on_mask ? layer->mask : layer->heights;
}

static void count(WrHeightCounts *h, const WrField *field)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    const int step = 1 + (int)sqrt((double)width * height / SAMPLES);
    float low, high;
    wr_field_range(field, &low, &high);
    *h = (WrHeightCounts){ .key = wr_field_key(field), .low = (double)low, .high = (double)high };
    if (!(h->low < h->high)) h->high = h->low + 1.0;
    for (int j = step / 2; j < height; j += step)
        for (int i = step / 2; i < width; i += step) {
            double at = ((double)wr_field_get(field, i, j) - h->low) / (h->high - h->low);
            int bin = (int)(at * WR_HEIGHT_BINS);
            h->count[bin < WR_HEIGHT_BINS ? bin : WR_HEIGHT_BINS - 1]++;
        }
    for (int k = 0; k < WR_HEIGHT_BINS; k++)
        h->most = h->count[k] > h->most ? h->count[k] : h->most;
}

static double height_x(const WrPad *pad, WrHeightSpan span, double height)
{
    return pad->x + pad->w * (height - span.low) / (span.high - span.low);
}

void wr_height_bars(const WrPad *pad, WrHeightSpan span, const WrHeightCounts *h)
{
    const double bin = (h->high - h->low) / WR_HEIGHT_BINS;
    for (int k = 0; k < WR_HEIGHT_BINS; k++) {
        /* square root, to show rare heights */
        double tall = pad->h * sqrt((double)h->count[k] / h->most);
        double x = height_x(pad, span, h->low + k * bin),
               right = height_x(pad, span, h->low + (k + 1) * bin);
        if (tall > 0.0)
            wr_gui_draw_fill(x, pad->y + pad->h - tall, fmax(right - x, 1.0), tall, 0xff6a6a6au, 0);
    }
}

/* Result of each height, as a fraction between the lowest and the highest result. */
static void curve(const WrPad *pad, WrHeightSpan span, double low, double high, double gamma)
{
    double before_x = 0.0, before_y = 0.0;
    for (int k = 0; k <= STEPS; k++) {
        double height = span.low + (span.high - span.low) * k / STEPS;
        double t = high > low ? fmin(fmax((height - low) / (high - low), 0.0), 1.0) : 0.0;
        double x = height_x(pad, span, height), y = pad->y + pad->h * (1.0 - pow(t, 1.0 / gamma));
        if (k) wr_gui_draw_line(before_x, before_y, x, y, WR_COLOUR_CELL, wr_gui_px(1));
        before_x = x;
        before_y = y;
    }
}

const WrHeightCounts *wr_height_counts(WrApp *app)
{
    WrHeightCounts *h = &app->adjust->histogram;
    const WrField *field = table_of(app);
    if (h->key != wr_field_key(field)) count(h, field);
    return h;
}

bool wr_levels_pad(WrApp *app)
{
    WrAdjust *adjust = app->adjust;
    const WrHeightCounts *h = wr_height_counts(app);
    double *low = &adjust->param[index_of(adjust->op, "in-low")];
    double *high = &adjust->param[index_of(adjust->op, "in-high")];
    WrHeightSpan span = { fmin(h->low, fmin(*low, *high)), fmax(h->high, fmax(*low, *high)) };
    WrPad pad = wr_gui_pad_begin("histogram", 0, wr_gui_px(ROOM_UNITS));
    if (adjust->held && pad.held)
        span = adjust->held_span.low < adjust->held_span.high ? adjust->held_span : span;
    wr_height_bars(&pad, span, h);
    curve(&pad, span, *low, *high, adjust->param[index_of(adjust->op, "gamma")]);
    for (int k = 0; k < 2; k++) {
        double x = height_x(&pad, span, k ? *high : *low);
        wr_gui_draw_line(x, pad.y, x, pad.y + pad.h, k ? 0xfff4f4f4u : WR_COLOUR_ACCENT,
                         wr_gui_px(2));
    }
    wr_gui_pad_end();
    if (!pad.held)
        wr_gui_tip("Histogram of the heights. Drag the blue line to the height that becomes low, "
                   "the white one to the height that becomes high");
    if (pad.pressed) {
        bool nearer_high = fabs(pad.pointer_x - height_x(&pad, span, *high)) <
                           fabs(pad.pointer_x - height_x(&pad, span, *low));
        adjust->held = nearer_high ? 2 : 1;
        adjust->held_span = span;
    }
    if (!pad.held || !adjust->held) {
        adjust->held = 0;
        return false;
    }
    double at = span.low + (span.high - span.low) * (pad.pointer_x - pad.x) / pad.w;
    at = fmin(fmax(at, span.low), span.high);
    double *value = adjust->held == 2 ? high : low, was = *value;
    *value = rint(at * 1e4) / 1e4;
    return *value != was;
}
