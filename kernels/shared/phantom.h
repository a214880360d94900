// The parts that computed volumes are made of: smooth solids in millimetres, joined or cut one after the other.
#ifndef CLVR_SHARED_PHANTOM_H
#define CLVR_SHARED_PHANTOM_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

#define CLVR_PART_ELLIPSOID 0 // |q| = 1
#define CLVR_PART_BLOCK 1     // sum of fourth powers of q = 1: an ellipsoid with square shoulders
#define CLVR_PART_TUBE 2      // round, its radius linear from end to end
#define CLVR_PART_BOX 3       // flat sides
#define CLVR_PART_CYLINDER 4  // flat ends; with a screw thread where it has a pitch

/// A solid. x is to the left of a patient or an animal, y posterior, z up.
typedef struct PhantomPart {
    float4 center; ///< w: beyond this distance from the centre the part has no effect
    float4 a;      ///< ellipsoid and block: a row of the matrix to the unit body (q = rows . (p - center)), w: 1 / radius; tube: start, w:
                   ///< radius there; box and cylinder: first unit axis, w: half size (box), radius (cylinder)
    float4 b;      ///< second row; tube: from start to end, w: 1 / length^2; box and cylinder: second unit axis, w: half size (box)
    float4 c;    ///< third row; tube: x: radius at the end less that at the start; box and cylinder: x: half size along the third axis, y:
                 ///< radius of the edges, z: the thread's turns per mm (0: none), w: its pitch [mm]
    float blend; ///< width of the smooth transition to what came before [mm]
    float quarter; ///< 1 / (4 blend)
    float sign;    ///< 1 joins, -1 cuts; a soft blob: its density
    int kind;
} PhantomPart;
CLVR_CHECK_SIZE(PhantomPart, 80);

/// What is made of a list of parts of the head; the order of the lists.
enum PhantomBody {
    CLVR_SKIN,   ///< the outline of the head
    CLVR_CAVITY, ///< inside of the braincase and of the spinal canal
    CLVR_FACE,   ///< bones but the braincase
    CLVR_TEETH,
    CLVR_AIR,     ///< nose, sinuses, throat, ear canals
    CLVR_ORBIT,   ///< eye sockets: fat
    CLVR_GLOBE,   ///< eyeballs
    CLVR_STRANDS, ///< muscles in fat, turbinates in air
    CLVR_CEREBRUM,
    CLVR_CEREBELLUM,
    CLVR_VENTRICLES,
    CLVR_VESSELS, ///< with contrast agent; the only ones that are not mirrored
    CLVR_BODIES
};
enum SnakeBody { CLVR_SNAKE_EGG, CLVR_SNAKE_FLESH, CLVR_SNAKE_GUT, CLVR_SNAKE_BONE, CLVR_SNAKE_BODIES };
enum BeetleBody { CLVR_BEETLE_TRUNK, CLVR_BEETLE_LIMBS, CLVR_BEETLE_HAIRS, CLVR_BEETLE_BODIES };
enum VesselBody { CLVR_VESSEL_LOBE, CLVR_VESSEL_TREE, CLVR_VESSEL_BODIES };
enum SkullBody {
    CLVR_SKULL_CAVITY,
    CLVR_SKULL_FACE,
    CLVR_SKULL_TEETH,
    CLVR_SKULL_AIR,
    CLVR_SKULL_ORBIT,
    CLVR_SKULL_HOLDER,
    CLVR_SKULL_WIRES,
    CLVR_SKULL_BODIES
};
enum FibresBody { CLVR_FIBRES_CARBON, CLVR_FIBRES_GLASS, CLVR_FIBRES_BODIES };
enum MachineBody { CLVR_MACHINE_ALUMINIUM, CLVR_MACHINE_STEEL, CLVR_MACHINE_BODIES };

/// The kernel displaces points by less than this along an axis [mm].
#define CLVR_PHANTOM_BEND 1.5f

/// Voxels along an axis of the cells for which the host lists the parts that can have an effect.
#define CLVR_CELL_X 16
#define CLVR_CELL_Y 8
#define CLVR_CELL_Z 8

typedef struct PhantomParams {
    int4 dims;      ///< xyz: voxels
    int4 cells;     ///< xy: cells
    float4 origin;  ///< xyz: position of voxel 0 [mm]; w: 1 / width of the ramp of partial volume [1/mm]
    float4 spacing; ///< xyz [mm]
    float far[12];  ///< per body: its distance is kept within +-far, so that a part beyond its reach has exactly no effect
    uint key0, key1;
    int opened; ///< 1: cut open to show skull and brain
    int pad;
} PhantomParams;
CLVR_CHECK_SIZE(PhantomParams, 128);

CLVR_SHARED_END
#endif
