// Shaders of render_client/shaders: their text.
declare module '*.glsl' {
  const text: string;
  export default text;
}
