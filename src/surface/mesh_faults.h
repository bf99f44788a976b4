/* mesh_faults.h - faults of a mesh's edges and faces: each kind with its count and the place of the first.

   Faces are compared by the positions of their corners, so that seams of normals and (u,v) are no faults. A doubled face
   counts once: its edges are counted as if it were not there. Slicers refuse or repair such meshes. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;
typedef struct WrTriangles WrTriangles;

typedef enum WrMeshFault {
    WR_MESH_FAULT_OPEN,    /* edges of one face: holes and borders */
    WR_MESH_FAULT_CROWDED, /* edges of more than two faces */
    WR_MESH_FAULT_TURNED,  /* edges that both faces have in the same direction: one faces inwards */
    WR_MESH_FAULT_DOUBLED, /* faces on the same three positions as an earlier one, on either side */
    WR_MESH_FAULT_NO_AREA, /* faces without area, which were removed (triangles.h) */
    WR_MESH_FAULTS
} WrMeshFault;

typedef struct WrMeshFaultRow {
    const char *name, *label; /* in machine-readable output; in reports */
    bool ambiguous;           /* slicers have to guess the inside; the others they close or drop */
} WrMeshFaultRow;
extern const WrMeshFaultRow wr_mesh_fault_rows[WR_MESH_FAULTS];

typedef struct WrMeshFaults {
    int32_t count[WR_MESH_FAULTS];
    WrVec3 at[WR_MESH_FAULTS];   /* the middle of the first edge or face */
    bool placed[WR_MESH_FAULTS]; /* `at` is known: a document does not store it of removed faces */
} WrMeshFaults;

/* Finds the faults; a closed mesh has none but removed faces. origin: added to the places. Errors: out of memory. */
bool wr_mesh_faults_find(const WrTriangles *mesh, const double origin[3], WrMeshFaults *out,
                         WrError *err);
/* "closed", "open" if it has open edges, "no closed body" because of other faults. Static text. */
const char *wr_mesh_faults_body(const WrMeshFaults *faults, const WrTriangles *mesh);
/* Adds them to a report: "; open edges: 3, the first at 0,1,2; ...". */
void wr_mesh_faults_text(const WrMeshFaults *faults, WrText *text);
