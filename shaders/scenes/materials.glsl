// The surfaces of a model, whatever the shading. In a scene that has materials it follows the inputs.
struct SheerMaterial {
    int picture;   // layer of u_pictures; -1 for none
    float cutoff;  // opaque fragments of less alpha are not there; 0 where all are
};

layout(std430, binding = 4) readonly buffer SheerMaterials { SheerMaterial sheer_materials[]; };
