/* tangents_dump FILE: prints the corners of a mesh with their MikkTSpace frames, one per line, three lines per
   triangle: position, normal, u and v, t, sign. For tangents_blender.sh. */
#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "scene/scene.h"
#include "surface/tangent_frames.h"

#include <stdio.h>

static void print(const WrTriangleCorner *c, const WrTangent *t)
{
    for (int k = 0; k < 3; k++) printf("%.9g ", (double)c->p[k]);
    for (int k = 0; k < 3; k++) printf("%.9g ", (double)c->n[k]);
    printf("%.9g %.9g %.17g %.17g %.17g %g\n", (double)c->u, (double)c->v, t->t.x, t->t.y, t->t.z,
           t->sign);
}

int main(int count, char **argument)
{
    char line[4096];
    WrError err = { "" };
    const WrSessionOptions options = { 0 };
    WrSession *session = wr_session_new(&options);
    snprintf(line, sizeof line, "surface mesh file=\"%s\"", count == 2 ? argument[1] : "");
    if (!wr_session_run(session, line, &err)) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    const WrTriangles *mesh = wr_session_document(session)->scene->triangles;
    WrTangent *frame = wr_alloc(3 * (size_t)mesh->triangle_count, sizeof *frame);
    if (!mesh->mapped) {
        fprintf(stderr, "no texture coordinates\n");
        return 1;
    }
    if (!wr_tangents_mikk(mesh->corners, mesh->triangles, mesh->triangle_count, frame, &err)) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            print(&mesh->corners[mesh->triangles[i].corner[k]], &frame[3 * i + k]);
    wr_free(frame);
    wr_session_free(session);
    return 0;
}
