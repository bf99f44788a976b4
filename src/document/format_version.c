#include "document/format_version.h"

#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "scene/tone_mapping.h"

/* True if the scene has an area lamp, or one that objects can hide. */
static bool any_new_lamp(const WrScene *scene)
{
    bool any = false;
    for (int i = 0; i < scene->light_count; i++)
        any |= scene->lights[i].size_deg != 0 || scene->lights[i].shadow;
    return any;
}

static WrSceneAge age_of_object(const WrScene *object)
{
    const bool pictured =
        object->facets[WR_FACET_ROUGHNESS].image || object->facets[WR_FACET_METALNESS].image;
    const bool driving = object->grain.kind != WR_SOLID_TEXTURE_OFF &&
                         object->grain.drives != WR_SOLID_TEXTURE_COLOURS;
    if (pictured || driving || object->material.occlusion || object->parallax ||
        (object->colouring.count > 0 && object->colouring.hollow))
        return WR_SCENE_OF_FACETS;
    if (object->grain.kind != WR_SOLID_TEXTURE_OFF || object->material.shadow || object->displaced)
        return WR_SCENE_OF_CELL;
    return WR_SCENE_OLD;
}

WrSceneAge wr_scene_age(const WrScene *scene)
{
    WrSceneAge age = WR_SCENE_OLD;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrSceneAge own = age_of_object(wr_scene_object(scene, i));
        age = own > age ? own : age;
    }
    if (any_new_lamp(scene) || scene->dials.horizons != wr_dials_default().horizons ||
        scene->dials.rays != wr_dials_default().rays ||
        scene->dials.steps != wr_dials_default().steps || scene->camera.frame != 0 ||
        *scene->sheet.as)
        return WR_SCENE_OF_FACETS;
    if (wr_cell_size_given(&scene->cell) || !wr_tone_curve(&scene->tone).plain)
        return age > WR_SCENE_OF_CELL ? age : WR_SCENE_OF_CELL;
    return age;
}
