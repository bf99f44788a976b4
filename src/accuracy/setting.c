/* Settings of the dials: what differs from a scene, as a scene and as text. */
#include "accuracy/ladder.h"

WrScene *wr_setting_apply(const WrSetting *setting, const WrScene *scene)
{
    WrScene *out = wr_scene_clone(scene);
    for (int i = 0; i < setting->count; i++) wr_dials[setting->dial[i]].set(out, setting->value[i]);
    return out;
}

void wr_setting_print(const WrSetting *setting, WrText *text)
{
    if (setting->count == 0) wr_text_add(text, "as it stands");
    for (int i = 0; i < setting->count; i++) {
        const WrDial *dial = &wr_dials[setting->dial[i]];
        wr_text_addf(text, "%s%s=", i > 0 ? " " : "", dial->name);
        if (dial->choices > 0) wr_text_add(text, dial->choice((int)setting->value[i]));
        else wr_text_add_number(text, setting->value[i]);
    }
}
