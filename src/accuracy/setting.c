/* Dial settings: differences from a scene, applied to a scene or printed as text. */
#include "accuracy/ladder.h"

#include "scene/objects.h"
#include "scene/scene.h"

WrScene *wr_setting_apply(const WrSetting *setting, const WrScene *scene)
{
    WrScene *out = wr_scene_clone(scene);
    bool scheme = false, normals = false;
    for (int i = 0; i < setting->count; i++) {
        wr_dials[setting->dial[i]].set(out, setting->value[i]);
        scheme |= setting->dial[i] == WR_DIAL_SCHEME;
        normals |= setting->dial[i] == WR_DIAL_NORMAL;
    }
    if (scheme || normals) wr_scene_set_all_slopes(out, scheme, normals);
    return out;
}

static void add_dial(const WrDial *dial, double value, WrText *text)
{
    wr_text_addf(text, "%s%s=", text->length > 0 ? " " : "", dial->name);
    if (dial->choices > 0) wr_text_add(text, dial->choice((int)value));
    else wr_text_add_number(text, value);
}

void wr_setting_present(const WrScene *scene, WrText *text)
{
    WrScene *usual = wr_scene_new();
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        const double value = dial->get(scene);
        const bool told = dial->axis < WR_AXIS_VISIBILITY || value != dial->get(usual);
        if (told && (!dial->matters || dial->matters(scene))) add_dial(dial, value, text);
    }
    wr_scene_free(usual);
}

void wr_setting_print(const WrSetting *setting, WrText *text)
{
    WrText words = { 0 };
    for (int i = 0; i < setting->count; i++)
        add_dial(&wr_dials[setting->dial[i]], setting->value[i], &words);
    wr_text_add(text, setting->count > 0 ? wr_text_get(&words) : "as it stands");
    wr_text_fini(&words);
}
