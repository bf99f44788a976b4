#include "base/error.h"
#include "base/exactmath.h"
#include "brush/preset_internal.h"

#include <math.h>
#include <string.h>

#define LN2 0.69314718055994530942

WrPreset *wr_preset_new(const char *name)
{
    WrPreset *preset = wr_alloc(1, sizeof *preset);
    preset->references = 1;
    preset->name = wr_strdup(name);
    preset->own = wr_brush_default();
    preset->own.radius = 0.0;
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++)
        preset->base[i] = wr_preset_setting(i)->fallback;
    WrCurve pressure = { .setting = MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY,
                         .input = MYPAINT_BRUSH_INPUT_PRESSURE,
                         .count = 2,
                         .points = { { 0.0f, 0.0f }, { 1.0f, 1.0f } } };
    wr_array_push(&preset->curves, pressure);
    return preset;
}

void wr_preset_drop_curves(WrPreset *preset, int setting)
{
    int kept = 0;
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].setting != setting)
            preset->curves.data[kept++] = preset->curves.data[i];
    preset->curves.count = kept;
}

WrPreset *wr_preset_share(const WrPreset *preset)
{
    WrPreset *shared = (WrPreset *)(uintptr_t)preset; /* immutable except for this count */
    if (shared) __atomic_fetch_add(&shared->references, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_preset_free(WrPreset *preset)
{
    if (!preset || __atomic_sub_fetch(&preset->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free(preset->name);
    wr_free(preset->comment);
    wr_free(preset->description);
    wr_free(preset->group);
    wr_free(preset->notes);
    wr_free(preset->tip_file);
    wr_tip_free(preset->tip);
    wr_array_free(&preset->curves);
    wr_free(preset);
}

/* ---- properties ---- */

const char *wr_preset_name(const WrPreset *preset)
{
    return preset->name;
}

const char *wr_preset_description(const WrPreset *preset)
{
    return preset->description ? preset->description : "";
}

const char *wr_preset_group(const WrPreset *preset)
{
    return preset->group ? preset->group : "";
}

const WrTip *wr_preset_tip(const WrPreset *preset)
{
    return preset->tip;
}

const char *wr_preset_tip_file(const WrPreset *preset)
{
    return preset->tip_file ? preset->tip_file : "";
}

int wr_preset_skipped(const WrPreset *preset)
{
    return preset->skipped;
}

double wr_preset_value(const WrPreset *preset, int index)
{
    WR_ASSERT(index >= 0 && index < MYPAINT_BRUSH_SETTINGS_COUNT);
    return preset->base[index];
}

const WrCurve *wr_preset_find_curve(const WrPreset *preset, int setting, int input)
{
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *curve = &preset->curves.data[i];
        if (curve->setting == setting && curve->input == input) return curve;
    }
    return NULL;
}

bool wr_preset_is_constant(const WrPreset *preset, int index)
{
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].setting == index) return false;
    return true;
}

int wr_preset_curve(const WrPreset *preset, int index, int input, const float (**points)[2])
{
    const WrCurve *curve = wr_preset_find_curve(preset, index, input);
    if (!curve) return 0;
    *points = curve->points;
    return curve->count;
}

double wr_preset_peak(const WrPreset *preset, int setting)
{
    double sum = preset->base[setting];
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *curve = &preset->curves.data[i];
        if (curve->setting != setting) continue;
        double peak = curve->points[0][1];
        for (int k = 1; k < curve->count; k++)
            if (curve->points[k][1] > peak) peak = curve->points[k][1];
        sum += peak;
    }
    return sum;
}

bool wr_preset_uses(const WrPreset *preset, int setting)
{
    return wr_preset_peak(preset, setting) > 0.0;
}

bool wr_preset_is_random(const WrPreset *preset)
{
    static const int chance[] = { MYPAINT_BRUSH_SETTING_OFFSET_BY_RANDOM,
                                  MYPAINT_BRUSH_SETTING_RADIUS_BY_RANDOM,
                                  MYPAINT_BRUSH_SETTING_TRACKING_NOISE };
    for (size_t i = 0; i < sizeof chance / sizeof *chance; i++)
        if (preset->base[chance[i]] != 0.0 || !wr_preset_is_constant(preset, chance[i]))
            return true;
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].input == MYPAINT_BRUSH_INPUT_RANDOM) return true;
    return false;
}

/* ---- behaviour ---- */

bool wr_preset_smudges(const WrPreset *preset)
{
    return wr_preset_uses(preset, MYPAINT_BRUSH_SETTING_SMUDGE);
}

bool wr_preset_sprays(const WrPreset *preset)
{
    return wr_preset_uses(preset, MYPAINT_BRUSH_SETTING_DABS_PER_SECOND);
}

bool wr_preset_is_colour_only(const WrPreset *preset)
{
    /* Presets that only tint, or only change existing paint, completely and always; or that never cover
       anything. */
    static const int tints[] = { MYPAINT_BRUSH_SETTING_LOCK_ALPHA, MYPAINT_BRUSH_SETTING_COLORIZE,
                                 MYPAINT_BRUSH_SETTING_POSTERIZE };
    for (size_t i = 0; i < sizeof tints / sizeof *tints; i++)
        if (wr_preset_is_constant(preset, tints[i]) && preset->base[tints[i]] >= 1.0) return true;
    return !wr_preset_uses(preset, MYPAINT_BRUSH_SETTING_OPAQUE) ||
           !wr_preset_uses(preset, MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY);
}

WrBrush wr_preset_brush(const WrPreset *preset)
{
    WrBrush brush = preset->own;
    brush.preset = preset;
    brush.tip = preset->tip;
    brush.hardness = preset->base[MYPAINT_BRUSH_SETTING_HARDNESS];
    if (!(brush.radius > 0.0)) {
        /* Rounded to a millionth of a texel, so that 16 is restored exactly from its logarithm. */
        double radius = wr_exp2(preset->base[MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC] / LN2);
        brush.radius = rint(radius * 1e6) / 1e6;
    }
    if (!preset->gives_mode && preset->base[MYPAINT_BRUSH_SETTING_ERASER] >= 0.5)
        brush.mode = WR_BRUSH_ERASE;
    return brush;
}
