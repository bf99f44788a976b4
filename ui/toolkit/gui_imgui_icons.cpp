/* Icons missing in the icon font, drawn on a grid of 24 units. */
#include "ui/toolkit/gui_imgui.h"

#include <string.h>

/* Transformation from the grid to the window. */
struct Sheet {
    ImDrawList *list;
    ImVec2 at;
    float unit;
    ImU32 ink;
};

static ImVec2 on(const Sheet &sheet, float x, float y)
{
    return ImVec2(sheet.at.x + x * sheet.unit, sheet.at.y + y * sheet.unit);
}

static void box(const Sheet &sheet, float x0, float y0, float x1, float y1, float round)
{
    sheet.list->AddRectFilled(on(sheet, x0, y0), on(sheet, x1, y1), sheet.ink, round * sheet.unit);
}

/* A rubber stamp: knob, neck, foot, and the printed line. */
static void stamp(const Sheet &sheet)
{
    sheet.list->AddCircleFilled(on(sheet, 12, 5.6f), 3.4f * sheet.unit, sheet.ink, 24);
    sheet.list->AddQuadFilled(on(sheet, 10.6f, 7), on(sheet, 13.4f, 7), on(sheet, 14.6f, 14),
                              on(sheet, 9.4f, 14), sheet.ink);
    box(sheet, 4, 13.2f, 20, 17.8f, 1.4f);
    box(sheet, 4, 19.6f, 20, 21.4f, 0);
}

/* One half, the axis, and the mirrored half. */
static void mirror(const Sheet &sheet)
{
    for (int i = 0; i < 4; i++) {
        const float y = 2.2f + 5.4f * (float)i;
        box(sheet, 11.2f, y, 12.8f, y + 3.4f, 0);
    }
    sheet.list->AddTriangleFilled(on(sheet, 9.4f, 5), on(sheet, 9.4f, 19), on(sheet, 2, 19),
                                  sheet.ink);
    sheet.list->AddTriangle(on(sheet, 14.9f, 6.8f), on(sheet, 14.9f, 18.3f),
                            on(sheet, 20.9f, 18.3f), sheet.ink, 1.5f * sheet.unit);
}

bool wr_gui_draw_icon(ImDrawList *list, const char *icon, ImVec2 at, float side, ImU32 ink)
{
    const Sheet sheet = { list, at, side / 24, ink };
    if (strcmp(icon, WR_ICON_STAMP) == 0) stamp(sheet);
    else if (strcmp(icon, WR_ICON_MIRROR) == 0) mirror(sheet);
    else return false;
    return true;
}
