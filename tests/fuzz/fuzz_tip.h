/* fuzz_tip.h - invariants of every loaded brush tip. */
#pragma once
#include "base/error.h"
#include "brush/tip.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition) abort();
}

static void check_cell(const WrTip *tip, int cell)
{
    static const double scales[] = { 2, 0.3, 0.01 };
    int width, height;
    wr_tip_size(tip, cell, &width, &height);
    require(width >= 1 && width <= WR_TIP_SIDE && height >= 1 && height <= WR_TIP_SIDE);
    for (int k = 0; k < 3; k++) {
        WrTipView view;
        wr_tip_view(tip, cell, scales[k], &view);
        for (double s = -0.2; s < 1.3; s += 0.1) {
            float value = wr_tip_value(&view, s, 1 - s);
            require(value >= 0.0f && value <= 1.0f);
        }
    }
}

static void check_tip(const uint8_t *bytes, size_t size)
{
    WrError err = { "" };
    WrTip *tip = wr_tip_parse(bytes, size, "fuzz", &err);
    require(tip || err.text[0]);
    if (!tip) return;
    int cells = wr_tip_cells(tip);
    require(cells >= 1 && cells <= WR_TIP_CELLS && (size_t)cells <= size);
    require(wr_tip_spacing(tip) >= 0 && wr_tip_spacing(tip) <= 10);
    require(strlen(wr_tip_name(tip)) <= size);
    for (int i = 0; i < cells; i++) check_cell(tip, i);
    for (uint64_t n = 0; n < 5; n++) {
        int cell =
            wr_tip_pick(tip, n * 977, (double)n * 1.7 - 3, (double)n * 0.3, (double)n * 0.25);
        require(cell >= 0 && cell < cells);
    }
    wr_tip_free(tip);
}
