/* The inputs of libmypaint 1.6, in its own order: properties of pen and motion that can control a
   setting. low and high are the plot range of a curve; most inputs exceed it occasionally. */
#include "brush/preset_internal.h"

#include "base/error.h"

#include <string.h>

static const WrInputInfo inputs[MYPAINT_BRUSH_INPUTS_COUNT] = {
    [MYPAINT_BRUSH_INPUT_PRESSURE] = { "pressure", "Pressure", "How hard the pen presses.", 0, 1 },
    [MYPAINT_BRUSH_INPUT_SPEED1] = { "speed1", "Fine speed",
                                     "How fast the pen is just now, on a logarithmic scale.", 0,
                                     4 },
    [MYPAINT_BRUSH_INPUT_SPEED2] = { "speed2", "Gross speed", "The same, changing slowly.", 0, 4 },
    [MYPAINT_BRUSH_INPUT_RANDOM] = { "random", "Chance", "Another number for each dab.", 0, 1 },
    [MYPAINT_BRUSH_INPUT_STROKE] = { "stroke", "Stroke",
                                     "Rises from 0 to 1 along a stroke, and may begin anew.", 0,
                                     1 },
    [MYPAINT_BRUSH_INPUT_DIRECTION] = { "direction", "Direction",
                                        "Of the path, degrees; back and forth are the same.", 0,
                                        180 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATION] = { "tilt_declination", "Tilt",
                                               "90 degrees: the pen stands upright, 0: it lies.", 0,
                                               90 },
    [MYPAINT_BRUSH_INPUT_TILT_ASCENSION] = { "tilt_ascension", "Tilt's direction",
                                             "Where the pen leans to, degrees.", -180, 180 },
    [MYPAINT_BRUSH_INPUT_CUSTOM] = { "custom", "Custom",
                                     "What the setting `custom_input` draws it to.", -2, 2 },
    [MYPAINT_BRUSH_INPUT_DIRECTION_ANGLE] = { "direction_angle", "Direction all round",
                                              "Of the path, degrees; back and forth differ.", 0,
                                              360 },
    [MYPAINT_BRUSH_INPUT_ATTACK_ANGLE] = { "attack_angle", "Attack",
                                           "Between the pen's lean and the path, degrees.", -180,
                                           180 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATIONX] = { "tilt_declinationx", "Tilt across",
                                                "The pen's lean to the right, degrees.", -90, 90 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATIONY] = { "tilt_declinationy", "Tilt up and down",
                                                "The pen's lean downwards, degrees.", -90, 90 },
    [MYPAINT_BRUSH_INPUT_GRIDMAP_X] = { "gridmap_x", "Place across",
                                        "In squares that the table is parted into.", 0, 256 },
    [MYPAINT_BRUSH_INPUT_GRIDMAP_Y] = { "gridmap_y", "Place up and down",
                                        "In squares that the table is parted into.", 0, 256 },
    [MYPAINT_BRUSH_INPUT_VIEWZOOM] = { "viewzoom", "Zoom",
                                       "Of the view, logarithmic; strokes here are drawn at 0.",
                                       -2.77, 4.15 },
    [MYPAINT_BRUSH_INPUT_BARREL_ROTATION] = { "barrel_rotation", "Pen's turn",
                                              "About its own axis, degrees; 0 here.", -180, 180 },
    [MYPAINT_BRUSH_INPUT_BRUSH_RADIUS] = { "brush_radius", "Radius",
                                           "Logarithm of the brush's radius in texels.", -2, 6 },
};

int wr_preset_input_count(void)
{
    return MYPAINT_BRUSH_INPUTS_COUNT;
}

const WrInputInfo *wr_preset_input(int input)
{
    WR_ASSERT(input >= 0 && input < MYPAINT_BRUSH_INPUTS_COUNT);
    return &inputs[input];
}

int wr_preset_input_find(const char *name)
{
    for (int i = 0; i < MYPAINT_BRUSH_INPUTS_COUNT; i++)
        if (strcmp(inputs[i].name, name) == 0) return i;
    return -1;
}

double wr_preset_reach(int setting)
{
    const MyPaintBrushSettingInfo *info = mypaint_brush_setting_info((MyPaintBrushSetting)setting);
    return (double)info->max - (double)info->min;
}
