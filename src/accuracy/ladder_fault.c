/* Detection of contradictory arithmetic rungs: more bits, but farther from the reference. That is never the cost
   of an approximation but a fault of the program, and is reported as one. */
#include "accuracy/ladder_internal.h"
#include "base/enum_rows.h"
#include "scene/scene.h"

#include <math.h>

/* A smaller excess of the error is attributed to chance: roundings that add to the samples' own error. */
#define FACTOR 1.25
#define FLOOR 1e-5 /* RMS of linear intensity */

/* Rank by cost; -1: not of this axis. Of 16 bits and half precision either may be closer, depending on the
   table's level and range. */
static int dearness(int dial, double value)
{
    WR_ROWS(heights);
    static const int heights[] = { [WR_ROW(WR_HEIGHTS_DOUBLE)] = 3,
                                   [WR_ROW(WR_HEIGHTS_FLOAT)] = 2,
                                   [WR_ROW(WR_HEIGHTS_HALF)] = 1,
                                   [WR_ROW(WR_HEIGHTS_16)] = 1,
                                   [WR_ROW(WR_HEIGHTS_8)] = 1 };
    WR_ROWS_END(heights, WR_HEIGHTS_COUNT);
    WR_ROWS(shadings);
    static const int shadings[] = { [WR_ROW(WR_SHADING_DOUBLE)] = 3,
                                    [WR_ROW(WR_SHADING_FLOAT)] = 2,
                                    [WR_ROW(WR_SHADING_HALF)] = 1 };
    WR_ROWS_END(shadings, WR_SHADING_COUNT);
    WR_ROWS(arithmetics);
    static const int arithmetics[] = { [WR_ROW(WR_ARITHMETIC_EXACT)] = 2,
                                       [WR_ROW(WR_ARITHMETIC_FAST)] = 1 };
    WR_ROWS_END(arithmetics, WR_ARITHMETIC_COUNT);
    const int rung = (int)value;
    if (dial == WR_DIAL_HEIGHTS) return heights[rung];
    if (dial == WR_DIAL_SHADING) return shadings[rung];
    return dial == WR_DIAL_ARITHMETIC ? arithmetics[rung] : -1;
}

/* True for a rung of one arithmetic dial that has an own_rms. */
static bool plain(const WrRung *rung)
{
    return rung->axis == WR_AXIS_ARITHMETIC && rung->setting.count == 1 && !rung->model &&
           !rung->note.text[0] && !isnan(rung->own_rms);
}

static bool farther(double rms, double than)
{
    return rms > FACTOR * than + FLOOR;
}

static void compare(WrRung *dear, int dial, double cheap_value, double cheap_rms)
{
    if (dearness(dial, dear->setting.value[0]) <= dearness(dial, cheap_value) ||
        !farther(dear->own_rms, cheap_rms))
        return;
    dear->fault = true;
    dear->fault_than = cheap_value;
    dear->fault_rms = cheap_rms;
}

void wr_ladder_faults(WrLadder *ladder, const WrScene *scene)
{
    for (int i = 0; i < ladder->count; i++) {
        WrRung *rung = &ladder->rungs[i];
        rung->fault = false;
        if (!plain(rung)) continue;
        const int dial = rung->setting.dial[0];
        if (!isnan(ladder->arithmetic_rms))
            compare(rung, dial, wr_dials[dial].get(scene), ladder->arithmetic_rms);
        for (int k = 0; k < ladder->count; k++) {
            const WrRung *other = &ladder->rungs[k];
            if (plain(other) && other->setting.dial[0] == dial)
                compare(rung, dial, other->setting.value[0], other->own_rms);
        }
    }
}

/* "heights=double is farther from the reference than heights=float" */
bool wr_ladder_fault_print(const WrRung *rung, WrText *text)
{
    if (!rung->fault) return false;
    const WrDial *dial = &wr_dials[rung->setting.dial[0]];
    wr_text_addf(text, "%s=%s is farther from the reference (%.1e) than %s=%s (%.1e)", dial->name,
                 dial->choice((int)rung->setting.value[0]), rung->own_rms, dial->name,
                 dial->choice((int)rung->fault_than), rung->fault_rms);
    return true;
}
