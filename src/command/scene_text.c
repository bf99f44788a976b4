/* The scene as the canonical lines that restore it from a new document. Every setting is written out,
   defaults too, so that a document means the same whatever the defaults of a later version are. Only
   the light of a new document, the surface's own pose and a missing picture have no line. */
#include "command/inner.h"

#include "base/text.h"
#include "scene/scene.h"

#include <string.h>

/* "x,y,z" */
void wr_print_vec3(WrText *text, WrVec3 a)
{
    wr_text_add_number(text, a.x);
    wr_text_add(text, ",");
    wr_text_add_number(text, a.y);
    wr_text_add(text, ",");
    wr_text_add_number(text, a.z);
}

/* " name=x" */
void wr_print_named(WrText *text, const char *name, double x)
{
    wr_text_addf(text, " %s=", name);
    wr_text_add_number(text, x);
}

void wr_print_named_vec3(WrText *text, const char *name, WrVec3 a)
{
    wr_text_addf(text, " %s=", name);
    wr_print_vec3(text, a);
}

static void print_colour_content(const WrScene *scene, WrText *text)
{
    if (scene->colour && *scene->colour_sha256)
        wr_text_addf(text, "colour sha256=%s\n", scene->colour_sha256);
    else wr_print_colour(scene, text);
}

void wr_print_identity(const WrScene *scene, WrText *text)
{
    for (int i = 0; i < wr_command_count; i++) {
        if (strcmp(wr_commands[i]->name, "colour") == 0) print_colour_content(scene, text);
        else if (wr_commands[i]->print) wr_commands[i]->print(scene, text);
    }
}
