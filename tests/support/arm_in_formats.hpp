// The rig of two_joint_rig.hpp, whose elbow turns by 90 degrees about z within 1 s, as COLLADA and as FBX. The files' unit is the
// centimetre.
#pragma once

#include <string>

namespace test_support {

// bind_shape: the scale of the bind shape matrix, and the inverse one of the points.
inline std::string collada_arm(int bind_shape = 1)
{
    const std::string s = std::to_string(bind_shape);
    const std::string points = bind_shape == 1 ? "1 0 0 1 2 0 1 4 0 2 2 0" : "0.5 0 0 0.5 1 0 0.5 2 0 1 1 0";
    const auto source = [](const std::string& id, int count, int stride, const std::string& array, const std::string& text,
                           const std::string& parameter) {
        const std::string numbers = std::to_string(count * stride);
        return "<source id='" + id + "'><" + array + " id='" + id + "-array' count='" + numbers + "'>" + text + "</" + array +
               "><technique_common><accessor source='#" + id + "-array' count='" + std::to_string(count) + "' stride='" +
               std::to_string(stride) + "'>" + parameter + "</accessor></technique_common></source>";
    };
    const auto parameter = [](const std::string& name, const std::string& type) {
        return "<param name='" + name + "' type='" + type + "'/>";
    };
    const std::string xyz = parameter("X", "float") + parameter("Y", "float") + parameter("Z", "float");
    return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="arm" name="arm"><mesh>)" +
           source("points", 4, 3, "float_array", points, xyz) + R"(
<vertices id="vertices"><input semantic="POSITION" source="#points"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#vertices" offset="0"/><p>0 1 3 1 2 3</p></triangles></mesh></geometry>
</library_geometries>
<library_controllers><controller id="skin"><skin source="#arm"><bind_shape_matrix>)" +
           s + " 0 0 0 0 " + s + " 0 0 0 0 " + s + " 0 0 0 0 1</bind_shape_matrix>" +
           source("joints", 2, 1, "Name_array", "root elbow", parameter("JOINT", "name")) +
           source("binds", 2, 16, "float_array", "1 0 0 -1 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 -1 0 1 0 -2 0 0 1 0 0 0 0 1",
                  parameter("TRANSFORM", "float4x4")) +
           source("weights", 4, 1, "float_array", "1 0.5 0.25 0.75", parameter("WEIGHT", "float")) + R"(
<joints><input semantic="JOINT" source="#joints"/><input semantic="INV_BIND_MATRIX" source="#binds"/></joints>
<vertex_weights count="4"><input semantic="JOINT" source="#joints" offset="0"/><input semantic="WEIGHT" source="#weights" offset="1"/>
<vcount>1 2 1 2</vcount><v>0 0 0 1 1 1 1 0 0 2 1 3</v></vertex_weights></skin></controller></library_controllers>
<library_animations><animation id="bend" name="Bend">)" +
           source("times", 2, 1, "float_array", "0 1", parameter("TIME", "float")) +
           source("angles", 2, 1, "float_array", "0 90", parameter("ANGLE", "float")) +
           source("kinds", 2, 1, "Name_array", "LINEAR LINEAR", parameter("INTERPOLATION", "name")) + R"(
<sampler id="sampler"><input semantic="INPUT" source="#times"/><input semantic="OUTPUT" source="#angles"/>
<input semantic="INTERPOLATION" source="#kinds"/></sampler>
<channel source="#sampler" target="elbow/turn.ANGLE"/></animation></library_animations>
<library_visual_scenes><visual_scene id="scene">
<node id="root" sid="root" name="root" type="JOINT"><translate sid="place">1 0 0</translate>
<node id="elbow" sid="elbow" name="elbow" type="JOINT"><translate sid="place">0 2 0</translate><rotate sid="turn">0 0 1 0</rotate></node>
</node>
<node id="body" name="body"><instance_controller url="#skin"><skeleton>#root</skeleton></instance_controller></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene></COLLADA>
)";
}

inline std::string fbx_arm()
{
    const auto joint = [](const std::string& id, const std::string& name, const std::string& place) {
        return "Model: " + id + ", \"Model::" + name + "\", \"LimbNode\" {\nVersion: 232\nProperties70: {\nP: \"Lcl Translation\", " +
               "\"Lcl Translation\", \"\", \"A\"," + place + "\n}\n}\n";
    };
    const auto cluster = [](const std::string& id, const std::string& indices, const std::string& weights, const std::string& y) {
        return "Deformer: " + id + ", \"SubDeformer::\", \"Cluster\" {\nVersion: 100\nIndexes: *3 {\na: " + indices +
               "\n}\nWeights: *3 {\na: " + weights + "\n}\nTransform: *16 {\na: 1,0,0,0,0,1,0,0,0,0,1,0,-1,-" + y +
               ",0,1\n}\nTransformLink: *16 {\na: 1,0,0,0,0,1,0,0,0,0,1,0,1," + y + ",0,1\n}\n}\n";
    };
    return R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
FBXHeaderVersion: 1003
FBXVersion: 7400
}
GlobalSettings:  {
Version: 1000
Properties70:  {
P: "UpAxis", "int", "Integer", "",1
P: "UpAxisSign", "int", "Integer", "",1
P: "FrontAxis", "int", "Integer", "",2
P: "FrontAxisSign", "int", "Integer", "",1
P: "CoordAxis", "int", "Integer", "",0
P: "CoordAxisSign", "int", "Integer", "",1
P: "UnitScaleFactor", "double", "Number", "",1
}
}
Objects:  {
Geometry: 1, "Geometry::arm", "Mesh" {
Vertices: *12 {
a: 1,0,0,1,2,0,1,4,0,2,2,0
}
PolygonVertexIndex: *6 {
a: 0,1,-4,1,2,-4
}
GeometryVersion: 124
}
Model: 2, "Model::body", "Mesh" {
Version: 232
}
)" + joint("3", "root", "1,0,0") +
           joint("4", "elbow", "0,2,0") + "Deformer: 5, \"Deformer::\", \"Skin\" {\nVersion: 101\n}\n" +
           cluster("6", "0,1,3", "1,0.5,0.25", "0") + cluster("7", "1,2,3", "0.5,1,0.75", "2") + R"(
AnimationStack: 8, "AnimStack::Bend", "" {
Properties70:  {
P: "LocalStop", "KTime", "Time", "",46186158000
}
}
AnimationLayer: 9, "AnimLayer::Base", "" {
}
AnimationCurveNode: 10, "AnimCurveNode::R", "" {
Properties70:  {
P: "d|X", "Number", "", "A",0
P: "d|Y", "Number", "", "A",0
P: "d|Z", "Number", "", "A",0
}
}
AnimationCurve: 11, "AnimCurve::", "" {
Default: 0
KeyVer: 4008
KeyTime: *2 {
a: 0,46186158000
}
KeyValueFloat: *2 {
a: 0,90
}
}
}
Connections:  {
C: "OO",2,0
C: "OO",3,0
C: "OO",4,3
C: "OO",1,2
C: "OO",5,1
C: "OO",6,5
C: "OO",7,5
C: "OO",3,6
C: "OO",4,7
C: "OO",9,8
C: "OO",10,9
C: "OP",10,4, "Lcl Rotation"
C: "OP",11,10, "d|Z"
}
)";
}

}  // namespace test_support
