// Shaders of render_client/look/shaders: their text.
declare module '*.glsl' {
  const text: string;
  export default text;
}
