// Where the parts of the computed head are. Sizes after an average adult; nothing here is a scan.
#include "host/phantom/parts.hpp"

namespace clvr {
namespace {

void outline(MadeVolume& head) {
    SolidBody skin(head.bodies[shared::CLVR_SKIN]);
    skin.ellipsoid({0, 3, 52}, {76, 97, 78}, 1)
        .ellipsoid({0, 44, 14}, {60, 50, 44}, 18)         // back of the head
        .ellipsoid({0, -40, 4}, {60, 50, 56}, 22)         // face
        .ellipsoid({0, -40, -52}, {44, 50, 36}, 18, 0.12) // lower jaw
        .block({0, 24, -100}, {50, 50, 140}, 22, 0.16)    // neck
        .ellipsoid({50, -36, -5}, {19, 32, 14}, 16)       // cheek bones
        .ellipsoid({34, -64, -34}, {21, 20, 24}, 18)      // cheeks
        .ellipsoid({46, -16, -40}, {14, 24, 34}, 16)      // jaw angle
        .ellipsoid({56, 14, -14}, {14, 18, 22}, 16)       // behind the ear
        .tube({{10, -82, -76, 9}, {24, -73, -77, 10}, {39, -46, -73, 11}, {46, -20, -65, 11}}, 18)
        .ellipsoid({40, -40, -34}, {18, 22, 28}, 18)
        .ellipsoid({52, -6, 4}, {20, 28, 30}, 16)                         // before the ear
        .ellipsoid({20, -86, 33}, {28, 12, 10}, 16, 0, 0.3)               // brows
        .ellipsoid({47, -64, 14}, {12, 14, 24}, 14)                       // outside of the eyes
        .cut({33, -104, 15}, {17, 17, 11}, 15)                            // eye sockets
        .ellipsoid({32, -75, 15}, {14, 13.5, 12.5}, 6)                    // eyes, lids closed
        .ellipsoid({0, -86, -34}, {27, 18, 18}, 12)                       // upper jaw
        .ellipsoid({19, -82, -8}, {13, 13, 18}, 12)                       // beside the nose
        .ellipsoid({0, -88, -76}, {20, 15, 16}, 14)                       // chin
        .tube({{0, -84, 24, 9}, {0, -91, -9, 15}}, 12)                    // nose: root
        .tube({{0, -90, 26, 6.5}, {0, -101, 9, 6}, {0, -112, -9, 7}}, 12) // bridge
        .ellipsoid({0, -112, -12}, {8.5, 9, 8}, 7)                        // tip
        .ellipsoid({12, -102.5, -15}, {6.2, 9.5, 6.5}, 6)                 // wings
        .ellipsoid({0, -101, -21}, {4, 9, 4}, 4)                          // columella
        .tube({{5.8, -110, -27, 2.8}, {5.5, -98, -16, 3}}, 2, -1)         // nostrils
        .curve({{0, -101.6, -40, 4.6}, {5, -102, -39.2, 5}, {13, -99.5, -40.5, 4.4}, {20, -94.5, -42.5, 3.2}, {25, -88, -44.5, 2}}, 5,
               3) // lips
        .curve({{0, -100, -49.5, 5.8}, {10, -98.3, -49.3, 5.2}, {18, -94.5, -47.5, 3.6}, {24, -88, -45.5, 2}}, 5, 3)
        .curve({{0, -107.6, -44.9, 1.2}, {6, -107, -44.4, 1.2}, {13, -104.5, -44.4, 1.2}, {20, -99, -44.8, 1.1}, {27, -91, -45.6, 1}}, 2, 2,
               -1)                                                          // mouth
        .cut({0, -110, -33}, {2.5, 5, 7}, 4)                                // philtrum
        .cut({0, -108, -61}, {22, 9, 4}, 10)                                // furrow above the chin
        .tube({{54, 14, -24, 8}, {36, -8, -75, 8}, {13, -26, -128, 8}}, 14) // neck muscles
        .ellipsoid({0, -22, -100}, {18, 17, 40}, 18);                       // larynx
    // Lids: a seam where they meet, a fold above.
    skin.tube({{21, -85, 13.5, 1.5}, {27, -88, 13, 1.6}, {36, -87.6, 13, 1.6}, {44, -82, 14, 1.4}}, 3)
        .tube({{19, -86.5, 11.5, 1.2}, {26, -90, 10.2, 1.2}, {36, -89.8, 10, 1.2}, {46, -82, 12, 1.2}}, 1.5, -1)
        .tube({{20, -87, 20, 1.2}, {27, -90, 22.5, 1.2}, {36, -89, 22.5, 1.2}, {46, -81, 19, 1.2}}, 3, -1);
    // Ear: a shell turned outwards, hollow in front, with a rim, an inner rim, a lobe and the flap before the canal.
    skin.ellipsoid({79, 13, 8}, {4.5, 17, 29}, 5, -0.12, -0.6)
        .cut({87, 7, 9}, {6, 12, 20}, 3, -0.12, -0.6)
        .curve({{70, 4, 6, 2.6},
                {73, -1, 14, 2.6},
                {74, -1, 24, 2.8},
                {77, 3, 33, 2.8},
                {83, 12, 38, 2.8},
                {89, 22, 33, 2.8},
                {91, 26, 20, 2.6},
                {89, 22, 5, 2.4},
                {84, 14, -9, 2.4}},
               2.5, 3)
        .curve({{80, 6, 29, 2}, {86, 15, 22, 2.2}, {86, 17, 10, 2.2}, {82, 11, -3, 2.2}, {77, 4, -7, 2.2}}, 3, 3)
        .ellipsoid({78, 7, -17}, {4, 7, 9}, 5, -0.1, -0.6)
        .cut({82, 6, 5}, {6, 6, 9}, 3)
        .ellipsoid({75, -2, 3}, {3, 4, 6}, 4);
}

void bones(MadeVolume& head) {
    SolidBody cavity(head.bodies[shared::CLVR_CAVITY]);
    cavity.ellipsoid({0, 1.5, 52}, {64, 87, 65.5}, 1)
        .cut({0, -72, -10}, {62, 46, 40}, 8)           // above the orbits
        .cut({0, -2, -16}, {80, 120, 22}, 8)           // base
        .ellipsoid({33, -10, 16}, {27, 30, 22}, 8)     // temporal lobes
        .ellipsoid({0, 44, 8}, {48, 36, 30}, 10)       // cerebellum
        .cut({0, -16, 4}, {15, 17, 16}, 6)             // body of the sphenoid
        .tube({{20, 2, -2, 8}, {62, 12, 8, 9}}, 6, -1) // petrous bones
        .tube({{0, 26, -6, 15}, {0, 30, -26, 13}}, 8)
        .tube({{0, 30, -22, 11}, {0, 31, -150, 10}}, 5); // spinal canal

    SolidBody face(head.bodies[shared::CLVR_FACE]);
    face.ellipsoid({0, -84, 40}, {24, 8, 14}, 6)
        .tube({{4, -87, 31, 6}, {24, -86, 35, 5}, {40, -78, 33, 5}, {50, -65, 25, 5}}, 6) // brows
        .tube({{50, -65, 25, 4.5}, {51, -62, 12, 4.5}, {49, -62, 2, 5}}, 5)               // outer rim of the orbit
        .tube({{49, -61, 2, 4.5}, {37, -69, -5, 4.5}, {24, -76, -3, 4}, {16, -81, 6, 4}, {11, -86, 24, 4.5}}, 5)
        .tube({{0, -88, 30, 6}, {0, -92, 22, 5}, {0, -98, 11, 4}}, 5)                           // nasal bones
        .ellipsoid({46, -58, -6}, {11, 11, 11}, 7, 0, 0.6)                                      // cheek bones
        .tube({{51, -52, -6, 5}, {60, -36, -5, 3.4}, {63, -18, -4, 3.2}, {61, -2, -2, 4.5}}, 4) // zygomatic arches
        .ellipsoid({24, -62, -14}, {19, 20, 22}, 8)                                             // upper jaw
        .ellipsoid({0, -64, -30}, {31, 27, 9}, 6)
        .ellipsoid({0, -20, 4}, {24, 22, 16}, 8)        // sphenoid
        .tube({{12, -34, -2, 4}, {14, -33, -28, 3}}, 5) // pterygoid
        .tube({{20, 0, -3, 9}, {62, 10, 3, 10}}, 6)     // petrous
        .ellipsoid({54, 15, -16}, {9, 12, 17}, 6)       // mastoid
        .tube({{30, -60, 29, 3}, {26, -36, 24, 4}}, 6)
        .ellipsoid({40, -36, 8}, {8, 16, 24}, 8) // greater wing
        .ellipsoid({0, 22, -20}, {24, 14, 6}, 6)
        .tube({{0, 90, 30, 3}, {0, 87, 22, 4}}, 8); // occipital protuberance
    // Lower jaw: body, chin, ramus with its two processes.
    const auto jaw = [](double z, double r) {
        return std::vector<Node>{{0, -86, z, r},      {13, -84.5, z, r},   {25, -76, z + 0.5, r},
                                 {34, -62, z + 1, r}, {41, -44, z + 3, r}, {47, -24, z + 8, r - 1}};
    };
    face.tube(jaw(-63, 5.2), 4).tube(jaw(-72, 5.4), 6).tube(jaw(-80, 5.4), 6);
    face.ellipsoid({0, -89, -80}, {15, 7, 7}, 6)
        .block({48.5, -17, -46}, {3.8, 16, 30}, 6, -0.28)
        .tube({{49, -8, -30, 4.5}, {52, -3, -10, 5}}, 5)
        .tube({{49, -26, -30, 4}, {49, -31, -9, 2.2}}, 6);
    // Sockets of the teeth.
    face.tube({{0, -84, -28, 5}, {12, -83, -28, 5}, {21, -76, -28, 5}, {27, -64, -29, 5}, {29, -50, -30, 5}}, 5)
        .tube({{0, -82, -58, 4}, {10, -81, -58, 4}, {19, -74, -58, 4}, {27, -60, -58, 4.5}, {33, -48, -58, 4.5}}, 5);
    // Openings.
    face.cut({0, -74, -6}, {11, 34, 18}, 3, 0.1).cut({0, -92, -2}, {11, 14, 15}, 4);
    // Hyoid bone.
    face.tube({{0, -24, -92, 3}, {14, -19, -91, 2.6}, {23, -4, -86, 2}}, 3);
    // Vertebrae: the first is a ring, the others have bodies, arches and spines.
    face.tube({{0, 14, -34, 5}, {13, 16, -34, 5.5}, {22, 26, -34, 7}, {32, 27, -34, 5}}, 4)
        .tube({{22, 28, -34, 5}, {14, 41, -34, 4.5}, {0, 46, -34, 5}}, 4)
        .tube({{0, 17, -32, 5}, {0, 16, -50, 6}}, 4);
    for (int i = 0; i < 5; ++i) {
        const double z = -51 - 17.5 * i, y = 14 - 0.8 * i * (4 - i) * 0.5;
        face.block({0, y, z}, {10.5, 9, 7}, 3, 0.1)
            .tube({{9, y + 6, z, 4.5}, {19, y + 9, z, 5}, {20, y + 14, z, 6}, {13, y + 24, z - 2, 3.6}, {0, y + 30, z - 4, 3.6}}, 4)
            .tube({{0, y + 30, z - 4, 3.8}, {0, y + (i == 0 || i == 4 ? 48 : 43), z - 9, 4.2}}, 4)
            .tube({{18, y + 7, z, 4}, {27, y + 2, z - 2, 3.4}}, 3);
    }

    SolidBody teeth(head.bodies[shared::CLVR_TEETH]);
    struct Tooth {
        double x, y, width, depth; ///< of the crown [mm], half sizes
    };
    const Tooth upper[] = {{4.4, -90.5, 4.2, 3.2},  {12.2, -88.5, 3.4, 3}, {19, -84, 3.7, 3.7}, {24.5, -77.5, 3.5, 4.2},
                           {28.2, -70.3, 3.5, 4.4}, {30.8, -61.3, 5, 5},   {32.6, -51, 4.9, 5}};
    const Tooth lower[] = {{2.8, -87.5, 2.6, 3}, {8.2, -86.5, 2.9, 3},  {14.2, -83.6, 3.3, 3.6}, {20, -78.6, 3.4, 3.8},
                           {24.6, -72, 3.5, 4},  {28.6, -63, 5.2, 4.7}, {32, -52, 5.2, 4.7}};
    for (int i = 0; i < 7; ++i) {
        const Tooth &u = upper[i], &l = lower[i];
        const double front = i < 3 ? 1 : 0, turn_u = 0.12 * i * (i < 4 ? 1 : 1.8), turn_l = turn_u;
        teeth.block({u.x, u.y, -38.3}, {u.width * 0.98, u.depth, 5.6 + front * 0.6}, 0.4, 0, turn_u)
            .tube({{u.x, u.y + 1, -34, 2.6}, {u.x * 0.94, u.y + 4, -22, 1.4}}, 1)
            .block({l.x, l.y, -50}, {l.width * 0.98, l.depth, 5.6 + front * 0.4}, 0.4, 0, turn_l)
            .tube({{l.x, l.y + 1, -54, 2.4}, {l.x * 0.98, l.y + 2, -66, 1.3}}, 1);
    }
}

void openings(MadeVolume& head) {
    SolidBody(head.bodies[shared::CLVR_AIR])
        .ellipsoid({6.5, -57, -8}, {4.6, 32, 17}, 1)                              // nose, to each side of the septum
        .tube({{5.5, -106, -24, 2.8}, {5.5, -96, -15, 3.4}, {6, -84, -12, 4}}, 3) // nostrils
        .ellipsoid({0, -22, -10}, {13, 11, 16}, 5)                                // throat
        .tube({{0, -14, -18, 9}, {0, -8, -48, 6}, {0, -9, -74, 7}, {0, -16, -104, 7.5}, {0, -16, -150, 8.5}}, 5)
        .ellipsoid({27, -60, -10}, {12, 15, 14}, 1)                 // maxillary sinuses
        .ellipsoid({9, -86, 37}, {8, 2.6, 6}, 1)                    // frontal
        .ellipsoid({7, -24, 6}, {5.5, 10, 7}, 1)                    // sphenoid
        .ellipsoid({9, -60, 16}, {3.2, 16, 7}, 1)                   // ethmoid
        .tube({{88, 5, 3, 3.2}, {70, 4, 2, 3.2}, {48, 2, 4, 3}}, 1) // ear canals
        .ellipsoid({54, 15, -14}, {4.5, 7, 11}, 1)                  // mastoid cells
        .ellipsoid({0, -72, -44.5}, {17, 14, 1.1}, 1);              // mouth
    SolidBody(head.bodies[shared::CLVR_ORBIT]).ellipsoid({29, -64, 15.5}, {18.5, 31, 17}, 1, 0, 0.42);
    SolidBody(head.bodies[shared::CLVR_GLOBE]).ellipsoid({32, -75, 15}, {12, 12, 12}, 1);
    SolidBody(head.bodies[shared::CLVR_STRANDS])
        .tube({{30, -64, 15, 1.8}, {20, -42, 17, 1.8}, {12, -28, 19, 1.8}}, 1) // optic nerve
        .tube({{21, -70, 15, 1.8}, {16, -50, 16, 2.4}, {15, -36, 17, 1.6}}, 1) // straight muscles of the eye
        .tube({{43, -70, 15, 1.8}, {32, -50, 16, 2.4}, {18, -36, 17, 1.6}}, 1)
        .tube({{31, -70, 26, 1.8}, {24, -50, 25, 2.4}, {16, -36, 19, 1.6}}, 1)
        .tube({{31, -70, 4, 1.8}, {24, -50, 6, 2.4}, {16, -36, 15, 1.6}}, 1)
        .tube({{8.5, -84, -15, 2}, {8.5, -62, -17, 3}, {8.5, -36, -15, 2}}, 1) // turbinates
        .tube({{10, -80, -5, 1.6}, {9, -58, -5, 2.4}, {9, -36, -5, 1.6}}, 1);
}

void brain(MadeVolume& head) {
    SolidBody(head.bodies[shared::CLVR_CEREBRUM])
        .ellipsoid({0, 1.5, 53}, {61.5, 84.5, 62}, 1)
        .cut({0, -72, -10}, {64, 48, 43}, 8)
        .cut({0, 50, -8}, {62, 62, 33}, 5, 0.1)
        .cut({0, -2, -16}, {80, 120, 28}, 8)
        .ellipsoid({34, -9, 17}, {23, 28, 18}, 7)
        .cut({0, -6, 10}, {14, 22, 20}, 5)
        .tube({{14, -24, 24, 2.5}, {42, -20, 28, 2.2}, {60, 12, 44, 1.2}}, 3, -1); // lateral furrow
    SolidBody(head.bodies[shared::CLVR_CEREBELLUM])
        .ellipsoid({20, 46, 5}, {26, 27, 19}, 4)
        .tube({{0, 8, 26, 11}, {0, 12, 6, 13}, {0, 22, -14, 8}, {0, 30, -28, 6.5}, {0, 31, -150, 5.5}}, 5); // brain stem and cord
    SolidBody(head.bodies[shared::CLVR_VENTRICLES])
        .curve({{6, -30, 46, 3}, {9, -10, 56, 4.5}, {13, 16, 58, 4.5}, {24, 36, 46, 5.5}, {31, 20, 32, 3.5}, {33, 0, 22, 2.5}}, 3)
        .tube({{24, 36, 46, 4.5}, {20, 56, 44, 1.5}}, 3)
        .ellipsoid({0, 4, 40}, {2, 13, 8}, 2)
        .tube({{0, 18, 32, 1}, {0, 24, 14, 1.2}, {0, 28, 6, 5}}, 3);
}

/// The point above (x, y, z) on the ellipsoid of the braincase, `height` mm outside of its cavity.
Node on_vault(double x, double y, double z, double height, double radius) {
    const Double3 c{0, 1.5, 52}, r{64 + height, 87 + height, 65.5 + height}, d{x - c[0], y - c[1], z - c[2]};
    const double s = 1 / norm({d[0] / r[0], d[1] / r[1], d[2] / r[2]});
    return {c[0] + s * d[0], c[1] + s * d[1], c[2] + s * d[2], radius};
}

void vessels(MadeVolume& head) {
    SolidBody v(head.bodies[shared::CLVR_VESSELS]);
    // Carotid arteries, through the skull's base to the circle of Willis.
    v.curves({{24, 4, -150, 3.2},
              {24, 1, -100, 3.2},
              {25, -3, -80, 3.8},
              {27, 2, -64, 2.8},
              {26, 3, -40, 2.6},
              {25, 1, -14, 2.5},
              {20, -4, -4, 2.4},
              {12, -10, 0, 2.4},
              {11, -22, 10, 2.4},
              {12, -29, 18, 2.4},
              {13, -20, 23, 2.3},
              {13, -15, 27, 2.2}},
             0.8)
        .curves({{13, -15, 27, 2}, {24, -16, 28, 1.9}, {36, -14, 27, 1.8}, {44, -8, 31, 1.7}}, 0.8)
        .curves({{13, -15, 27, 1.7},
                 {5, -22, 28, 1.6},
                 {2.5, -32, 32, 1.5},
                 {2.5, -46, 42, 1.5},
                 {2.5, -50, 58, 1.4},
                 {3, -38, 72, 1.3},
                 {3, -10, 80, 1.2},
                 {3, 20, 80, 1.1},
                 {3, 40, 72, 0.9}},
                0.8)
        .curves({{2.5, -46, 42, 1.2}, {3, -62, 52, 1.1}, {3, -62, 74, 1.1}, {3, -44, 94, 1}, {3, -16, 104, 0.9}}, 0.8)
        .curve({{5, -22, 28, 1.3}, {0, -23, 28.5, 1.2}, {-5, -22, 28, 1.3}}, 0.8)
        .curves({{13, -15, 26, 1.2}, {12, -6, 25, 1.1}, {10, 1, 24, 1.2}}, 0.8)
        .curves(
            {{0, -3, 22, 1.7}, {8, 0, 24, 1.6}, {17, 10, 25, 1.5}, {22, 26, 28, 1.4}, {20, 46, 32, 1.2}, {10, 68, 38, 1}, {6, 78, 48, 0.8}},
            0.8)
        .curve({{0, 6, -4, 2.1}, {0, 0, 8, 2.1}, {0, -3, 22, 2}}, 0.8);
    v.curves({{15, 20, -150, 1.9},
              {17, 19, -100, 1.9},
              {17, 19, -60, 1.9},
              {27, 25, -44, 1.9},
              {28, 28, -32, 1.9},
              {16, 38, -26, 1.9},
              {9, 26, -16, 1.9},
              {0, 6, -4, 1.9}},
             0.8);
    // Branches of the middle cerebral artery over the side of the brain.
    const double ends[][3] = {{50, -55, 60}, {56, -38, 80}, {60, -10, 92}, {60, 20, 88}, {58, 46, 72}, {58, 52, 48}, {62, 20, 24}};
    for (const auto& e : ends) {
        const Node start{44, -8, 31, 1.6}, end = on_vault(e[0], e[1], e[2], -3.5, 1.2);
        const Node near = on_vault(0.75 * 44 + 0.25 * e[0] + 8, 0.75 * -8 + 0.25 * e[1], 0.7 * 33 + 0.3 * e[2] + 3, -7, 1.6);
        const Node half = on_vault(0.45 * 50 + 0.55 * e[0], 0.45 * -8 + 0.55 * e[1] + 4, 0.45 * 33 + 0.55 * e[2] - 2, -3.5, 1.5);
        const Node three = on_vault(e[0] + 3, 0.22 * -8 + 0.78 * e[1] - 3, 0.22 * 33 + 0.78 * e[2] + 2, -3.5, 1.4);
        v.curves({start, near, half, three, end}, 0.8, 3);
        v.curves({half, on_vault(e[0] + 4, e[1] * 0.7 + 12, e[2] * 0.8 + 16, -3.5, 1.3),
                  on_vault(e[0] - 4, e[1] * 0.9 + 14, e[2] + 18, -3.5, 1.1)},
                 0.8, 3);
    }
    // Venous sinuses and jugular veins; veins of the surface that join the sinus.
    v.curve({on_vault(0, -78, 70, 0, 1.5),
             on_vault(0, -60, 95, 0, 2.2),
             on_vault(0, -25, 117, 0, 2.8),
             on_vault(0, 15, 118, 0, 3.2),
             on_vault(0, 55, 105, 0, 3.5),
             on_vault(0, 80, 75, 0, 3.8),
             on_vault(0, 88, 50, 0, 4),
             {0, 79, 26, 4}},
            0.8)
        .curves({{0, 79, 26, 3.6},
                 {22, 74, 21, 3.8},
                 {44, 55, 15, 4},
                 {52, 36, 8, 4},
                 {49, 24, -6, 4},
                 {38, 18, -16, 4},
                 {33, 10, -28, 4.4},
                 {34, 8, -70, 5},
                 {33, 4, -110, 5.4},
                 {32, 4, -150, 5.4}},
                0.8);
    for (int i = 0; i < 5; ++i) {
        const double y = -52 + 26 * i;
        v.curves({on_vault(2, y + 8, 118 - 0.01 * y * y, -1.5, 1.6), on_vault(16, y + 2, 114 - 0.01 * y * y, -3, 1.5),
                  on_vault(34, y - 6, 100 - 0.01 * y * y, -3.5, 1.4), on_vault(46, y + (i % 2 ? 4 : -10), 84 - 0.01 * y * y, -3.5, 0.8)},
                 0.8, 3);
    }
    // Arteries outside of the skull: external carotid, temporal with two branches on the vault, facial, occipital.
    v.curves({{25, -3, -80, 2.4},
              {33, -6, -66, 2.2},
              {44, 0, -44, 2},
              {57, -3, -18, 1.8},
              {69, -8, 0, 1.6},
              {71, -9, 14, 1.6},
              on_vault(68, -12, 34, 8.5, 1.6)},
             0.8)
        .curves({on_vault(68, -12, 34, 8.5, 1.6), on_vault(64, -36, 48, 8.5, 1.5), on_vault(50, -60, 62, 8.5, 1.4),
                 on_vault(40, -66, 84, 8.5, 1.3), on_vault(20, -66, 100, 8.5, 1.2)},
                0.8)
        .curves({on_vault(68, -12, 34, 8.5, 1.6), on_vault(72, -6, 56, 8.5, 1.5), on_vault(64, 12, 84, 8.5, 1.4),
                 on_vault(50, 20, 104, 8.5, 1.3), on_vault(30, 40, 112, 8.5, 1.2)},
                0.8)
        .curves({{28, -6, -74, 1.7},
                 {38, -22, -84, 1.6},
                 {45, -44, -78, 1.5},
                 {40, -64, -58, 1.4},
                 {30, -81, -42, 1.4},
                 {22, -85, -22, 1.3},
                 {19, -83, -8, 1.1}},
                0.8)
        .curves({{27, -2, -74, 1.6},
                 {40, 16, -40, 1.5},
                 {52, 38, -14, 1.4},
                 {44, 70, 10, 1.2},
                 on_vault(34, 86, 40, 8.5, 1.4),
                 on_vault(30, 80, 70, 8.5, 1.3)},
                0.8);
}

} // namespace

MadeVolume head_volume(bool opened) {
    MadeVolume head{"head", {-96.8, -127, -122}, {193.6, 242, 255.2}, {176, 220, 232}, VoxelType::i16, {}, opened};
    for (const float far : {26.f, 18.f, 9.f, 3.f, 5.f, 6.f, 3.f, 3.f, 22.f, 14.f, 4.f, 3.f}) head.bodies.push_back({far, true, {}});
    head.bodies[shared::CLVR_VESSELS].mirrored = false;
    outline(head);
    bones(head);
    openings(head);
    brain(head);
    vessels(head);
    return head;
}

} // namespace clvr
