/* Rungs of arithmetic that contradict their own meaning: more bits, and farther from the reference. That is never
   an approximation's price, it is a fault of the program, and it is told as one. */
#include "accuracy/ladder_internal.h"
#include "base/enum_rows.h"
#include "scene/scene.h"

#include <math.h>

/* An error that is larger by no more is the chance of roundings that meet the samples' own error. */
#define FACTOR 1.25
#define FLOOR 1e-5 /* RMS of linear intensity */

/* More is dearer; -1: not of this axis. Of 16 bits and halves either may be the nearer, as the table's level
   and range have it. */
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

/* A rung of one dial of arithmetic: the dial's value, and its error with the other axes at their best. */
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
