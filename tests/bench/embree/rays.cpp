// Closest hits per second of Embree 3 on one thread, one ray at a time: what `cargo bench --bench trace rays_between_places`
// is compared with. Not part of the build:
//
//   apt install g++ libembree-dev
//   g++ -O3 -march=x86-64-v3 -o /tmp/rays tests/bench/embree/rays.cpp -lembree3
//   /tmp/rays assets/meshes/goblet.obj assets/meshes/wine_glass.obj

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

struct Vec {
    float x, y, z;
};

struct Mesh {
    std::vector<Vec> vertices;
    std::vector<unsigned> corners;
};

// Vertices and faces of an OBJ file; faces of more corners as fans.
static Mesh read_obj(const char* path) {
    Mesh mesh;
    char line[512];
    FILE* file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        Vec v;
        if (sscanf(line, "v %f %f %f", &v.x, &v.y, &v.z) == 3) {
            mesh.vertices.push_back(v);
        } else if (!strncmp(line, "f ", 2)) {
            std::vector<unsigned> face;
            for (char* word = strtok(line + 2, " \r\n"); word; word = strtok(nullptr, " \r\n"))
                face.push_back(unsigned(atoi(word)) - 1);
            for (size_t k = 2; k < face.size(); k++)
                mesh.corners.insert(mesh.corners.end(), {face[0], face[k - 1], face[k]});
        }
    }
    if (file) fclose(file);
    return mesh;
}

static RTCScene build(RTCDevice device, const Mesh& mesh) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec),
                                             mesh.vertices.size());
    memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec));
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(unsigned), mesh.corners.size() / 3);
    memcpy(corners, mesh.corners.data(), mesh.corners.size() * sizeof(unsigned));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

// Between two random places each, in the box of the mesh made half as large again.
static std::vector<RTCRayHit> rays_between_places(const Mesh& mesh, int count) {
    const float inf = std::numeric_limits<float>::infinity();
    Vec low{inf, inf, inf}, high{-inf, -inf, -inf};
    for (const Vec& v : mesh.vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(-0.25f, 1.25f);
    auto place = [&] {
        const float x = share(random), y = share(random), z = share(random);
        return Vec{low.x + x * (high.x - low.x), low.y + y * (high.y - low.y), low.z + z * (high.z - low.z)};
    };
    std::vector<RTCRayHit> rays(count);
    for (RTCRayHit& r : rays) {
        const Vec a = place(), b = place();
        memset(&r, 0, sizeof r);
        r.ray.org_x = a.x, r.ray.org_y = a.y, r.ray.org_z = a.z;
        r.ray.dir_x = b.x - a.x, r.ray.dir_y = b.y - a.y, r.ray.dir_z = b.z - a.z;
        r.ray.tfar = inf;
        r.ray.mask = ~0u;
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    return rays;
}

int main(int argc, char** argv) {
    RTCDevice device = rtcNewDevice("threads=1");
    for (int arg = 1; arg < argc; arg++) {
        const Mesh mesh = read_obj(argv[arg]);
        RTCScene scene = build(device, mesh);
        const std::vector<RTCRayHit> rays = rays_between_places(mesh, 400000);
        std::vector<double> seconds;
        size_t hits = 0;
        for (int run = 0; run < 7; run++) {
            const clock_t start = clock();
            hits = 0;
            for (RTCRayHit r : rays) {
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                rtcIntersect1(scene, &context, &r);
                hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            }
            seconds.push_back(double(clock() - start) / CLOCKS_PER_SEC);
        }
        std::sort(seconds.begin(), seconds.end());
        printf("%s: %zu triangles, %.1f %% hit, %.2f M rays/s\n", argv[arg], mesh.corners.size() / 3,
               100.0 * hits / rays.size(), rays.size() / seconds[3] / 1e6);
        rtcReleaseScene(scene);
    }
    rtcReleaseDevice(device);
}
