/* assimp.cpp - the module wrinkle_assimp.so; the only file that uses Assimp. Its interface is assimp.h.

   Workarounds for the library:
   - it opens files named in a file (materials, buffers, textures): here it can read only one file, in
     memory;
   - nodes of a scene may repeat a mesh any number of times: they are counted before anything is copied;
   - it does not always check indices: they are checked here. */
extern "C" {
#include "image/assimp.h"
}

#include "image/one_line.hpp"

#include <assimp/Importer.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <vector>

struct WrAssimpMesh {
    bool whole;
    std::vector<double> points;
    std::vector<int32_t> corners;
    std::vector<float> looks; /* 5 per point */
    std::vector<int32_t> firsts;
    std::vector<std::string> names;
};

/* Fails with the message reduced to one line. */
static bool fail(char *reason, const std::string &text)
{
    one_line(reason, WR_ASSIMP_REASON, text);
    return false;
}

/* ---- one file in memory ---- */

class MemoryStream : public Assimp::IOStream
{
  public:
    MemoryStream(const char *from, size_t count) : bytes(from), length(count)
    {
    }
    size_t Read(void *out, size_t size, size_t count) override
    {
        if (size == 0) return 0;
        size_t whole = (length - at) / size;
        if (count < whole) whole = count;
        std::memcpy(out, bytes + at, whole * size);
        at += whole * size;
        return whole;
    }
    size_t Write(const void *, size_t, size_t) override
    {
        return 0;
    }
    aiReturn Seek(size_t offset, aiOrigin origin) override
    {
        size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at : length;
        size_t to = origin == aiOrigin_END ? length - offset : base + offset;
        if (to > length) return aiReturn_FAILURE;
        at = to;
        return aiReturn_SUCCESS;
    }
    size_t Tell() const override
    {
        return at;
    }
    size_t FileSize() const override
    {
        return length;
    }
    void Flush() override
    {
    }

  private:
    const char *bytes;
    size_t length, at = 0;
};

class MemoryFiles : public Assimp::IOSystem
{
  public:
    MemoryFiles(const std::string &only, const char *from, size_t count)
        : name(only), bytes(from), length(count)
    {
    }
    bool Exists(const char *file) const override
    {
        return name == file;
    }
    char getOsSeparator() const override
    {
        return '/';
    }
    Assimp::IOStream *Open(const char *file, const char *mode) override
    {
        if (name != file && missed.empty()) missed = file;
        if (name != file || std::strchr(mode, 'w')) return nullptr;
        return new MemoryStream(bytes, length);
    }
    void Close(Assimp::IOStream *stream) override
    {
        delete stream;
    }
    std::string missed; /* the first other file that was requested */

  private:
    std::string name;
    const char *bytes;
    size_t length;
};

/* ---- the scene as one mesh ---- */

struct Visit {
    const aiNode *node;
    double to[12]; /* transform of its points: rows of a matrix with the translation last */
};

struct Limits {
    int64_t points, triangles;
};

static void follow(const double parent[12], const aiMatrix4x4 &m, double out[12])
{
    const double own[12] = {
        m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4
    };
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? parent[4 * row + 3] : 0.0;
            for (int k = 0; k < 3; k++) sum += parent[4 * row + k] * own[4 * k + column];
            out[4 * row + column] = sum;
        }
}

/* The cofactors transform normals; the sign of the determinant is negative for mirroring. */
static double cofactors(const double m[12], double c[9])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            const int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
            const int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            c[3 * row + column] = m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
        }
    return m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
}

/* Adds the normals and (u,v) of its points. */
static void add_looks(WrAssimpMesh &out, const aiMesh &mesh, const double m[12], bool moved)
{
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    const bool mapped = mesh.mTextureCoords[0] != nullptr;
    double c[9];
    const double sign = cofactors(m, c) < 0 ? -1 : 1;
    for (unsigned i = 0; i < mesh.mNumVertices; i++) {
        float look[5] = { 0, 0, 0, nothing, nothing };
        if (mesh.mNormals) {
            const double n[3] = { mesh.mNormals[i].x, mesh.mNormals[i].y, mesh.mNormals[i].z };
            for (int row = 0; row < 3; row++)
                look[row] = static_cast<float>(
                    moved
                        ? sign * (c[3 * row] * n[0] + c[3 * row + 1] * n[1] + c[3 * row + 2] * n[2])
                        : n[row]);
        }
        if (mapped) look[3] = mesh.mTextureCoords[0][i].x, look[4] = mesh.mTextureCoords[0][i].y;
        out.looks.insert(out.looks.end(), look, look + 5);
    }
}

/* The name of its material, if the file names one. */
static std::string part_name(const aiScene &scene, const aiMesh &mesh)
{
    if (mesh.mMaterialIndex >= scene.mNumMaterials) return mesh.mName.C_Str();
    const std::string name = scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
    return name.empty() || name == AI_DEFAULT_MATERIAL_NAME ? mesh.mName.C_Str() : name;
}

static bool add_mesh(WrAssimpMesh &out, const aiMesh &mesh, const double m[12],
                     const Limits &limits, char *reason)
{
    int64_t first = static_cast<int64_t>(out.points.size() / 3);
    int64_t count = static_cast<int64_t>(out.corners.size() / 3);
    if (first + mesh.mNumVertices > limits.points)
        return fail(reason, "more than " + std::to_string(limits.points) + " points");
    if (count + mesh.mNumFaces > limits.triangles)
        return fail(reason, "more than " + std::to_string(limits.triangles) + " triangles");
    static const double nothing[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    bool moved = std::memcmp(m, nothing, sizeof nothing) != 0;
    double c[9];
    const bool mirrored = moved && cofactors(m, c) < 0;
    if (out.whole) add_looks(out, mesh, m, moved);
    for (unsigned i = 0; i < mesh.mNumVertices; i++) {
        const aiVector3D &p = mesh.mVertices[i];
        if (!moved) { /* unchanged, bit for bit */
            out.points.insert(out.points.end(), { p.x, p.y, p.z });
            continue;
        }
        for (int row = 0; row < 3; row++)
            out.points.push_back(m[4 * row] * static_cast<double>(p.x) +
                                 m[4 * row + 1] * static_cast<double>(p.y) +
                                 m[4 * row + 2] * static_cast<double>(p.z) + m[4 * row + 3]);
    }
    for (unsigned i = 0; i < mesh.mNumFaces; i++) {
        const aiFace &face = mesh.mFaces[i];
        if (face.mNumIndices != 3) continue; /* points and lines have no area */
        for (int k = 0; k < 3; k++) {
            const unsigned point = face.mIndices[mirrored && k > 0 ? 3 - k : k];
            if (point >= mesh.mNumVertices)
                return fail(reason, "face " + std::to_string(i + 1) + " names point " +
                                        std::to_string(point) + " of " +
                                        std::to_string(mesh.mNumVertices));
            out.corners.push_back(static_cast<int32_t>(first + point));
        }
    }
    return true;
}

static bool add_scene(WrAssimpMesh &out, const aiScene &scene, const Limits &limits, char *reason)
{
    std::vector<Visit> open;
    Visit root = { scene.mRootNode, { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 } };
    if (root.node) open.push_back(root);
    while (!open.empty()) {
        Visit visit = open.back(), at = visit;
        open.pop_back();
        follow(visit.to, visit.node->mTransformation, at.to);
        for (unsigned i = 0; i < visit.node->mNumMeshes; i++) {
            unsigned mesh = visit.node->mMeshes[i];
            if (mesh >= scene.mNumMeshes)
                return fail(reason, "a node names a mesh that is not there");
            if (out.whole) {
                out.firsts.push_back(static_cast<int32_t>(out.corners.size() / 3));
                out.names.push_back(part_name(scene, *scene.mMeshes[mesh]));
            }
            if (!add_mesh(out, *scene.mMeshes[mesh], at.to, limits, reason)) return false;
        }
        for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
            at.node = visit.node->mChildren[i];
            open.push_back(at);
        }
    }
    return true;
}

static bool read_file(WrAssimpMesh &out, const void *bytes, size_t length, const char *ending,
                      const Limits &limits, char *reason)
{
    Assimp::Importer importer;
    std::string name = std::string("mesh.") + (*ending ? ending : "obj");
    if (*ending && !importer.IsExtensionSupported(std::string(".") + ending))
        return fail(reason,
                    std::string("is not a mesh file of a kind that can be read (.") + ending + ")");
    auto *files = new MemoryFiles(name, static_cast<const char *>(bytes), length);
    importer.SetIOHandler(files); /* the importer owns it */
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene *scene = importer.ReadFile(name, aiProcess_Triangulate);
    if (!scene && std::strstr(importer.GetErrorString(), "bad_alloc"))
        return fail(reason, "says that it holds more than there is memory for; it is damaged");
    if (!scene && !files->missed.empty() &&
        std::strstr(importer.GetErrorString(), files->missed.c_str()))
        return fail(reason, "cannot be read by itself: it keeps a part in another file, \"" +
                                files->missed.substr(0, 80) +
                                "\"; save it as one file (.glb, .obj, .ply, .stl)");
    if (!scene)
        return fail(reason, std::string("cannot be read, truncated or damaged (") +
                                importer.GetErrorString() + ")");
    return add_scene(out, *scene, limits, reason);
}

static WrAssimpMesh *mesh_read(const void *bytes, size_t length, const char *ending,
                               int64_t most_points, int64_t most_triangles, bool whole,
                               char *reason)
{
    const Limits limits = { most_points, most_triangles };
    try {
        auto mesh = std::make_unique<WrAssimpMesh>();
        mesh->whole = whole;
        if (read_file(*mesh, bytes, length, ending, limits, reason)) return mesh.release();
    } catch (const std::bad_alloc &) {
        fail(reason, WR_ASSIMP_NO_MEMORY);
    } catch (const std::exception &problem) {
        fail(reason, problem.what());
    } catch (...) {
        fail(reason, "unknown exception in the library");
    }
    return nullptr;
}

static int32_t mesh_points(const WrAssimpMesh *mesh)
{
    return static_cast<int32_t>(mesh->points.size() / 3);
}

static int32_t mesh_triangles(const WrAssimpMesh *mesh)
{
    return static_cast<int32_t>(mesh->corners.size() / 3);
}

static const double *point_data(const WrAssimpMesh *mesh)
{
    return mesh->points.data();
}

static const int32_t *corner_data(const WrAssimpMesh *mesh)
{
    return mesh->corners.data();
}

static const float *look_data(const WrAssimpMesh *mesh)
{
    return mesh->looks.data();
}

static int32_t mesh_parts(const WrAssimpMesh *mesh)
{
    return static_cast<int32_t>(mesh->firsts.size());
}

static int32_t mesh_part(const WrAssimpMesh *mesh, int32_t i, const char **name)
{
    *name = mesh->names[static_cast<size_t>(i)].c_str();
    return mesh->firsts[static_cast<size_t>(i)];
}

static void mesh_close(WrAssimpMesh *mesh)
{
    delete mesh;
}

extern "C" __attribute__((visibility("default"))) const WrAssimpTable wr_assimp_table;
const WrAssimpTable wr_assimp_table = { WR_ASSIMP_VERSION, mesh_read,   mesh_points, mesh_triangles,
                                        point_data,        corner_data, look_data,   mesh_parts,
                                        mesh_part,         mesh_close };
