// The surfaces of a model, whatever the shading. In a scene with materials it comes after the inputs.
struct SheerPicture {
    int array;     // of u_pictures; -1 for no picture
    int layer;
    int level;     // that holds the picture itself, its mipmaps follow
    int sampling;  // see sampling_bits in renderer/scene/scene_info.h
};

struct SheerMaterial {
    SheerPicture base;
    SheerPicture emission;
    vec3 emitted;  // linear light
    float cutoff;  // opaque fragments with less alpha are not drawn; 0 draws all
};

layout(std430, binding = 4) readonly buffer SheerMaterials { SheerMaterial sheer_materials[]; };
